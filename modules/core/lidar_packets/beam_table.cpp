#include "core/lidar_packets/beam_table.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <sstream>
#include <stdexcept>

#include "core/units.hpp"

namespace voqcal {
namespace {

double Wrapped(double angle_rad) {
  const double wrapped = std::fmod(angle_rad, 2 * M_PI);
  return wrapped < 0 ? wrapped + 2 * M_PI : wrapped;
}

// The numbers of a line, which commas divide; empty if one of them is no number.
std::vector<double> NumbersOf(const std::string& line) {
  std::vector<double> numbers;
  std::istringstream stream(line);
  for (std::string field; std::getline(stream, field, ',');) {
    char* end = nullptr;
    numbers.push_back(std::strtod(field.c_str(), &end));
    const bool is_number = end != field.c_str() && std::isfinite(numbers.back());
    if (!is_number || std::string(end).find_first_not_of(" \t\r") != std::string::npos) return {};
  }
  return numbers;
}

std::invalid_argument BadLine(int number, const std::string& rule, const std::string& line) {
  return std::invalid_argument("line " + std::to_string(number) + " must be " + rule + ", is \"" +
                               line.substr(0, 60) + '"');
}

}  // namespace

BeamTable BeamsAt(const std::vector<double>& elevations_deg,
                  const std::vector<double>& azimuths_deg) {
  BeamTable beams(elevations_deg.size());
  for (std::size_t i = 0; i < beams.size(); ++i) {
    beams[i].elevation_rad = elevations_deg[i] * kRadPerDeg;
    if (!azimuths_deg.empty()) beams[i].azimuth_rad = azimuths_deg[i] * kRadPerDeg;
  }
  NumberRings(&beams);
  return beams;
}

void NumberRings(BeamTable* beams) {
  std::vector<std::size_t> order(beams->size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [beams](std::size_t a, std::size_t b) {
    return (*beams)[a].elevation_rad < (*beams)[b].elevation_rad;
  });
  for (std::size_t ring = 0; ring < order.size(); ++ring) {
    (*beams)[order[ring]].ring = static_cast<int>(ring);
  }
}

void TakeElevations(const LidarUnit& unit, BeamTable* beams) {
  if (unit.elevations_rad.empty()) return;
  for (Beam& beam : *beams) beam.elevation_rad = unit.elevations_rad.at(beam.ring);
}

BeamTable ReadBeamCsv(const std::string& text, std::size_t num_beams) {
  BeamTable beams(num_beams);
  std::vector<bool> is_given(num_beams, false);
  std::istringstream lines(text);
  int line_number = 0;
  std::size_t num_given = 0;
  for (std::string line; std::getline(lines, line);) {
    ++line_number;
    const std::vector<double> numbers = NumbersOf(line);
    if (numbers.size() < 2) continue;  // a heading, a checksum, an empty line
    const bool has_channel = numbers.size() >= 3;
    const double channel = has_channel ? numbers[0] : static_cast<double>(num_given + 1);
    const double elevation_deg = numbers[has_channel ? 1 : 0];
    const double azimuth_deg = numbers[has_channel ? 2 : 1];
    const bool is_channel =
        channel >= 1 && channel <= static_cast<double>(num_beams) && channel == std::floor(channel);
    if (!is_channel || is_given[static_cast<std::size_t>(channel) - 1]) {
      throw BadLine(
          line_number, "of a channel from 1 to " + std::to_string(num_beams) + ", each once", line);
    }
    if (std::abs(elevation_deg) > 90 || std::abs(azimuth_deg) > 180) {
      throw BadLine(line_number, "channel, elevation within 90, azimuth within 180 degrees", line);
    }
    Beam& beam = beams[static_cast<std::size_t>(channel) - 1];
    beam.elevation_rad = elevation_deg * kRadPerDeg;
    beam.azimuth_rad = azimuth_deg * kRadPerDeg;
    is_given[static_cast<std::size_t>(channel) - 1] = true;
    ++num_given;
  }
  if (num_given != num_beams) {
    throw std::invalid_argument("must have a line \"channel,elevation,azimuth\" for each of " +
                                std::to_string(num_beams) + " channels, has " +
                                std::to_string(num_given));
  }
  NumberRings(&beams);
  return beams;
}

PacketReturn MeasuredBy(
    const Beam& beam, double head_rad, double distance_m, int intensity, ZeroAzimuth zero) {
  const double clockwise_rad = head_rad + beam.azimuth_rad;
  const double zero_rad = zero == ZeroAzimuth::kAlongX ? 0.0 : M_PI / 2;
  const double from_x_rad = zero_rad - clockwise_rad;
  const double cos_azimuth = std::cos(from_x_rad);
  const double sin_azimuth = std::sin(from_x_rad);
  const double cos_elevation = std::cos(beam.elevation_rad);
  const double sin_elevation = std::sin(beam.elevation_rad);
  const double range_m = distance_m + beam.range_m;
  const double across_m = range_m * cos_elevation - beam.above_centre_m * sin_elevation;
  PacketReturn result;
  result.point.position_m =
      Eigen::Vector3d(across_m * cos_azimuth - beam.beside_axis_m * sin_azimuth,
                      across_m * sin_azimuth + beam.beside_axis_m * cos_azimuth,
                      range_m * sin_elevation + beam.above_centre_m * cos_elevation)
          .cast<float>();
  if (beam.ahead_of_axis_m != 0.0) {
    const double head_from_x_rad = zero_rad - head_rad;
    result.point.position_m +=
        (beam.ahead_of_axis_m *
         Eigen::Vector3d(std::cos(head_from_x_rad), std::sin(head_from_x_rad), 0))
            .cast<float>();
  }
  result.point.intensity = static_cast<float>(intensity);
  result.point.ring = static_cast<std::uint16_t>(beam.ring);
  result.azimuth_rad = Wrapped(clockwise_rad);
  result.distance_m = distance_m;
  return result;
}

void BeamEchoes::Add(RawEcho echo) {
  if (echo.distance == 0 || size_ == kMaxEchoes) return;
  int place = size_;
  while (place > 0 && echoes_[place - 1].distance > echo.distance) --place;
  if (place > 0 && echoes_[place - 1].distance == echo.distance) return;
  std::copy_backward(echoes_.begin() + place, echoes_.begin() + size_, echoes_.begin() + size_ + 1);
  echoes_[place] = echo;
  ++size_;
}

}  // namespace voqcal
