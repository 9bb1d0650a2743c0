#pragma once

#include <string>

namespace voqcal {

/// What an LCM URL must be and is not, e.g. "must begin with ..."; empty if LCM 1.3 takes it. Needs
/// no network: whether there is a route or a broker shows when it is opened.
std::string LcmUrlProblem(const std::string& url);

}  // namespace voqcal
