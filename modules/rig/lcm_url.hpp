#pragma once

#include <string>

namespace voqcal {

/// Its recv_buf_size is what lets images and sweeps arrive; ttl=0 keeps everything on this host.
inline constexpr char kDefaultLcmUrl[] = "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4194304";

/// What an LCM URL must be and is not, e.g. "must begin with ..."; empty if LCM 1.3 takes it. Needs
/// no network: whether there is a route or a broker shows when it is opened.
std::string LcmUrlProblem(const std::string& url);

}  // namespace voqcal
