#include "rig/dashboard_options.hpp"

#include <arpa/inet.h>

#include "core/problems.hpp"
#include "files/option_section.hpp"

namespace voqcal {
namespace {

bool IsAddress(const std::string& text) {
  in6_addr address{};  // large enough for both
  return inet_pton(AF_INET, text.c_str(), &address) == 1 ||
         inet_pton(AF_INET6, text.c_str(), &address) == 1;
}

}  // namespace

std::vector<std::string> DashboardOptions::Problems() const {
  ProblemList problems;
  problems.Require(IsAddress(address), "address must be an IP address", "'" + address + "'");
  problems.Require(port >= 0 && port <= 65535, "port must be 0 to 65535", port);
  problems.RequirePositive("image_rate_hz", image_rate_hz);
  problems.RequirePositive("cloud_rate_hz", cloud_rate_hz);
  problems.Require(
      max_image_width_px >= 64, "max_image_width_px must be at least 64", max_image_width_px);
  problems.Require(max_cloud_points >= 1, "max_cloud_points must be positive", max_cloud_points);
  return problems.lines();
}

void ReadDashboard(OptionSection* top, DashboardOptions* options) {
  OptionSection section = top->Section("dashboard", "the web page of a live session");
  section.Read("address", &options->address, "IP address to listen at; 0.0.0.0: every network's");
  section.Read("port", &options->port, "0 to 65535; 0: any that is free");
  section.Read("host_name", &options->host_name, "a name to open the page by, besides addresses");
  section.Read("image_rate_hz", &options->image_rate_hz, "images shown a second, at most");
  section.Read("cloud_rate_hz", &options->cloud_rate_hz, "sweeps shown a second, at most");
  section.Read("max_image_width_px",
               &options->max_image_width_px,
               "larger images are halved until they fit; at least 64");
  section.Read("max_cloud_points", &options->max_cloud_points, "points shown of a sweep");
  section.AddProblems(options->Problems());
  section.RefuseUnknownKeys();
}

}  // namespace voqcal
