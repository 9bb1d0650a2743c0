#include "core/likelihood/likelihood_estimate.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace voqcal {

bool LensEstimate::IsObservable() const {
  return std::find(is_observable.begin(), is_observable.end(), true) != is_observable.end();
}

std::string LikelihoodExtrinsic::Summary() const {
  std::ostringstream text;
  text << "likelihood " << ToString(status);
  if (!IsUsable()) return text.str();
  constexpr double kDegreesPerRadian = 180.0 / M_PI;
  const Vector6d sigma = uncertainty.covariance.diagonal().cwiseSqrt();
  text.precision(3);
  text << ": 1 sigma up to " << kDegreesPerRadian * sigma.head<3>().maxCoeff() << " deg and "
       << 1000.0 * sigma.tail<3>().maxCoeff() << " mm; range offset " << bias.common.Text()
       << ", dark against bright " << bias.dark_step.Text();
  return text.str();
}

}  // namespace voqcal
