#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "core/geometry/rigid.hpp"
#include "core/lens_calibration/lens_view.hpp"
#include "core/lens_calibration/view_errors.hpp"

namespace voqcal {

/// What one view says of the lens' free parameters once its pose has taken what it can.
struct ViewInformation {
  Eigen::MatrixXd A;  ///< Jl'Jl - Jl'Jp (Jp'Jp)^-1 Jp'Jl
  Eigen::VectorXd u;  ///< Jl'r: at the minimum Jp'r = 0
  Eigen::MatrixXd J;  ///< Jl
};

/// @param lens, pose  the view's at the minimum.
/// @param num_parameters  that are free, the first.
ViewInformation InformationOf(const ViewErrors& errors,
                              const std::vector<double>& lens,
                              const Vector6d& pose,
                              int num_parameters);

/// s^2 A^-1, s^2 the residuals' variance, times how much more the views pull to all sides than
/// independent errors would have them do: their pulls u_v have then the covariance
/// s^2 (A_v - A_v A^-1 A_v), so that
///     ratio = sum u_v' A^-1 u_v / (s^2 (L - sum tr((A^-1 A_v)^2)))
/// is 1 on average.
/// @param coefficient_information  of each coefficient, before any view.
/// @return infinite where the views leave a parameter open.
Eigen::MatrixXd LensCovariance(const std::vector<ViewInformation>& views,
                               double coefficient_information,
                               double sum_px2,
                               std::size_t num_corners);

/// An error d of the parameters moves the seen corners u_i by J_i d, of which a change of scale s
/// about their middle m and a shift t take the most by least squares: [s; t] = (X'X)^-1 X'J d, with
/// rows X_i = [u_i - m, I].
Eigen::Matrix3d ScaleAndShiftCovariance(const std::vector<ViewInformation>& informations,
                                        const std::vector<LensView>& views,
                                        const Eigen::MatrixXd& covariance);

}  // namespace voqcal
