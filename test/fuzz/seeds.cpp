// fuzz_seeds CORPORA: writes the small inputs from which fuzzing starts, each as one file.
#include <cstdio>
#include <filesystem>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <opencv2/imgcodecs.hpp>

#include "files/atomic_file.hpp"
#include "fuzz/lcm_types.hpp"
#include "messaging/convert.hpp"
#include "messaging/encode.hpp"
#include "messaging/log.hpp"
#include "result/lidar_bias_yaml.hpp"
#include "result/result_file.hpp"
#include "rig/default_rig.hpp"
#include "support/pcap_file.hpp"
#include "support/spectrum_packet.hpp"
#include "support/synthetic_samples.hpp"
#include "support/vlp16_packet.hpp"

namespace voqcal::fuzz {
namespace {

namespace fs = std::filesystem;

class Corpora {
 public:
  explicit Corpora(fs::path folder) : folder_(std::move(folder)) {}

  void Write(const std::string& target, const std::string& name, const std::string& bytes) const {
    fs::create_directories(folder_ / target);
    WriteFileAtomically(folder_ / target / name, bytes);
  }

 private:
  fs::path folder_;
};

std::string Word(std::size_t value) {
  return {static_cast<char>(value >> 8), static_cast<char>(value)};
}

std::string AsText(const std::vector<std::uint8_t>& bytes) { return {bytes.begin(), bytes.end()}; }

std::string Vlp16Packets(std::uint8_t mode) {
  std::string text(1, '\x40');
  for (int i = 0; i < 3; ++i) {
    test::Vlp16PacketWriter packet(35000 + 480 * i, 40, 1000 + 1327U * i, mode);
    packet.SetAllEchoes(1500, 50);
    packet.SetEcho(2 * i, 0, i, 900, 80);
    text += Word(1) + AsText(packet.bytes);
  }
  return text;
}

std::string SpectrumPackets() {
  std::vector<test::SpectrumPoint> points(160);
  for (int i = 0; i < 160; ++i) {
    points[i] = {i, 40.0 + i / 2.0, -5.0, static_cast<std::uint32_t>(1000 + i), i};
  }
  const auto version_1 = test::SpectrumVersionOne(1000, 100, points);
  points.resize(5);
  const auto version_0 = test::SpectrumVersionZero(5000, points);
  return Word(1) + Word(version_1.size()) + AsText(version_1) + Word(2) + Word(version_0.size()) +
         AsText(version_0);
}

std::string Capture() {
  test::PcapFile file;
  for (int i = 0; i < 3; ++i) {
    test::Vlp16PacketWriter packet(35000 + 480 * i, 40, 1000 + 1327U * i);
    packet.SetAllEchoes(1500, 50);
    file.Add(1700000000000000 + 1327 * i, test::UdpFrame{2368, packet.bytes}.Ethernet());
  }
  file.Add(1700000001000000, test::UdpFrame{8308, {1, 2, 3}}.Ethernet());
  return file.Bytes();
}

std::string Pcd(const std::string& format, const std::string& data) {
  return std::string(1, '\0') +
         "VERSION 0.7\nFIELDS x y z intensity ring\nSIZE 4 4 4 4 2\nTYPE F F F F U\n"
         "COUNT 1 1 1 1 1\nWIDTH 2\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA " +
         format + "\n" + data;
}

std::string Ply(const std::string& format, const std::string& data) {
  return "\x01ply\nformat " + format +
         " 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
         "end_header\n" +
         data;
}

void WriteClouds(const Corpora& corpora) {
  corpora.Write("cloud_file", "pcd_ascii", Pcd("ascii", "1 2 3 50 1\n4 5 6 60 2\n"));
  corpora.Write("cloud_file", "pcd_binary", Pcd("binary", std::string(36, 'A')));
  // Sizes of 6 and 36 bytes, then what LZF makes of 36 zeros: one literal, one reference.
  const std::string lzf = {'\0', '\0', '\xE0', '\x1A', '\0', '\0'};
  corpora.Write("cloud_file",
                "pcd_compressed",
                Pcd("binary_compressed", std::string{6, 0, 0, 0, 36, 0, 0, 0} + lzf));
  corpora.Write("cloud_file", "ply_ascii", Ply("ascii", "1 2 3\n4 5 6\n"));
  corpora.Write("cloud_file", "ply_binary", Ply("binary_little_endian", std::string(24, 'A')));
}

void WriteImages(const Corpora& corpora) {
  cv::Mat image(12, 16, CV_8UC3);
  for (int i = 0; i < 12 * 16 * 3; ++i) image.data[i] = static_cast<std::uint8_t>(7 * i);
  const auto write = [&](const std::string& name,
                         const std::string& ending,
                         const cv::Mat& picture,
                         const std::vector<int>& flags) {
    std::vector<std::uint8_t> bytes;
    cv::imencode(ending, picture, bytes, flags);
    corpora.Write("images", name, AsText(bytes));
  };
  write("jpeg", ".jpg", image, {});
  write("jpeg_progressive", ".jpg", image, {cv::IMWRITE_JPEG_PROGRESSIVE, 1});
  write("jpeg_restarts", ".jpg", image, {cv::IMWRITE_JPEG_RST_INTERVAL, 1});
  write("png", ".png", image, {});
  cv::Mat grey;
  cv::extractChannel(image, grey, 0);
  write("jpeg_grey", ".jpg", grey, {});
  write("png_grey", ".png", grey, {});
}

template <typename Message>
constexpr std::size_t PlaceOf() {
  std::size_t place = 0;
  std::apply(
      [&place](auto... each) {
        bool is_found = false;
        ((is_found = is_found || std::is_same_v<decltype(each), Message>, place += !is_found), ...);
      },
      LcmTypes());
  return place;
}

template <typename Message>
void WriteMessage(const Corpora& corpora, const Message& message) {
  const std::vector<std::uint8_t> bytes = EncodeMessage(message);
  const std::string text(bytes.begin() + 8, bytes.end());  // without the fingerprint
  corpora.Write("lcm_messages",
                Message::getTypeName(),
                std::string(1, static_cast<char>(PlaceOf<Message>())) + text);
}

void WriteMessages(const Corpora& corpora) {
  std::apply([&corpora](const auto&... empty) { (WriteMessage(corpora, empty), ...); }, LcmTypes());
  test::SyntheticSamplesOptions options;
  options.num_samples = 2;
  std::vector<BoardSample> samples = test::SynthesizeSamples(options);
  samples[0].lidar.points_lidar_m.has_ring = true;
  samples[0].lidar.points_lidar_m.points.resize(3);
  samples[0].runners_up.push_back(samples[1].lidar);
  WriteMessage(corpora, ToMessage(samples, 3, true, "hash"));
  WriteMessage(corpora, ToMessage(samples[0]));
  WriteMessage(corpora, LidarBoardMessage({samples[0].lidar, samples[1].lidar}, "", 1, 0, 2));
  WriteMessage(corpora, CameraBoardMessage(samples[0].camera, "", "", 1, 2));
  WriteMessage(corpora, ToMessage(test::TestCamera(), 1, 2));
  PointCloud cloud;
  cloud.has_ring = cloud.has_intensity = cloud.has_time = true;
  cloud.points.resize(4);
  WriteMessage(corpora, ToMessage(cloud, 1, 2));
  WriteMessage(corpora, ToMessage(cv::Mat(3, 4, CV_8UC3, cv::Scalar(1, 2, 3)), 1, 2));
  AveragedExtrinsic averaged;
  averaged.is_kept = {true};
  averaged.reasons = {""};
  WriteMessage(corpora, ToMessage(averaged, {voq_set_t{}}, {SetExtrinsic{}}));
  WriteMessage(corpora, ToMessage(BestExtrinsic{}, {}));
  voq_sets_t sets{};
  sets.sets.push_back(ToMessage(VoqSet{}, {1, 2, 3}));
  sets.num_sets = 1;
  WriteMessage(corpora, sets);
}

std::string Table() {
  std::string text;
  for (int line = 0; line < 19; ++line) {
    const bool is_normal = line == 1 || line == 7;
    text += is_normal ? "0,0,-1\n" : std::to_string(10 * line) + ",20,3000\n";
  }
  return text;
}

void WriteAll(const fs::path& folder) {
  const Corpora corpora(folder);
  corpora.Write("vlp16_packets", "strongest", Vlp16Packets(0x37));
  corpora.Write("vlp16_packets", "dual", Vlp16Packets(0x39));
  corpora.Write("spectrum_packets", "both_versions", SpectrumPackets());
  corpora.Write("pcap", "ethernet", Capture());
  WriteClouds(corpora);
  const std::string events = AsText(EncodeLogEvent({1, 2, "FIRST", {1, 2, 3}})) +
                             AsText(EncodeLogEvent({2, 3, "SECOND", {}}));
  corpora.Write("log_events", "two_events", events);
  corpora.Write("log_events", "cut", events.substr(0, events.size() - 5));
  corpora.Write(
      "log_events", "damaged", events.substr(0, 20) + "damage" + events.substr(30) + events);
  WriteMessages(corpora);
  for (const char* rig : {"simulated_vlp16", "acfr_vlp16", "several_sensors"}) {
    const fs::path path =
        fs::path(VOQCAL_SOURCE_DIR) / "config/rigs" / (std::string(rig) + ".yaml");
    const bool has_names = std::string(rig) == "several_sensors";
    corpora.Write("rig_file", rig, ReadWholeFile(path) + (has_names ? "\npair: front,left\n" : ""));
  }
  corpora.Write("rig_file", "every_key", DefaultRigText());
  corpora.Write("poses_csv", "one_pose", Table());
  CalibrationResult result;
  result.lidar_bias.common = {0.01, 0.002, true};
  result.lidar_bias.rings.assign(2, {0.001, 0.002, true});
  corpora.Write("result_yaml", "result", ToYaml(result));
  corpora.Write("result_yaml",
                "by_hand",
                "T_camera_lidar: {quaternion_xyzw: [0, 0, 0, 1], translation_m: [1, 2, 3]}\n");
  WriteImages(corpora);
}

}  // namespace
}  // namespace voqcal::fuzz

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: %s FOLDER\n", argv[0]);
    return 2;
  }
  voqcal::fuzz::WriteAll(argv[1]);
}
