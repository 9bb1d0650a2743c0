#pragma once

#include <string>
#include <vector>

namespace voqcal {

class OptionSection;

/// The web page: where it is served, and how much of the sensors it shows.
struct DashboardOptions {
  std::string address = "127.0.0.1";  ///< IP address to listen at; "0.0.0.0": every network's.
  int port = 8765;                    ///< 0: any that is free.
  std::string host_name;  ///< By which the page may be opened, besides addresses and localhost.
  double image_rate_hz = 10.0;
  double cloud_rate_hz = 5.0;
  int max_image_width_px = 960;  ///< Larger images are halved until they fit.
  int max_cloud_points = 12000;

  /// One line for each broken constraint, with its value; empty if the options are usable.
  std::vector<std::string> Problems() const;
};

/// Reads the section `dashboard`.
void ReadDashboard(OptionSection* top, DashboardOptions* options);

}  // namespace voqcal
