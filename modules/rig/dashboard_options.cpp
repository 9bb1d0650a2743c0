#include "rig/dashboard_options.hpp"

#include <arpa/inet.h>

#include "core/problems.hpp"

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

void ReadDashboard(YamlSection* top, DashboardOptions* options) {
  YamlSection section = top->Section("dashboard");
  section.Read("address", &options->address);
  section.Read("port", &options->port);
  section.Read("host_name", &options->host_name);
  section.Read("image_rate_hz", &options->image_rate_hz);
  section.Read("cloud_rate_hz", &options->cloud_rate_hz);
  section.Read("max_image_width_px", &options->max_image_width_px);
  section.Read("max_cloud_points", &options->max_cloud_points);
  section.AddProblems(options->Problems());
  section.RefuseUnknownKeys();
}

}  // namespace voqcal
