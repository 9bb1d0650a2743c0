#pragma once

#include "core/assessment/diagnosis.hpp"
#include "core/assessment/fault_fit.hpp"
#include "core/likelihood/lidar_bias.hpp"

namespace voqcal {

/// Whether no lidar's ranges are off by as much, standard error allowed for: then something else is
/// wrong that looks like it, or the lidar is broken.
bool IsBeyondLidars(const BiasEstimate& range_offset, const DiagnosisOptions& options);

/// The offset that goes with a fit.
BiasEstimate RangeOffsetOf(const FaultFit& fit);

/// What is known of a lidar's offset before samples speak, as a log-likelihood: half the largest
/// possible is 1 sigma, and a broken lidar may be off by anything, though it is as rare as a
/// finding by chance.
double LogPriorOfRangeOffset(double offset_m, const DiagnosisOptions& options);

/// Reports an offset that no lidar has, unless the models have found what it comes from.
/// @param range_offset  what the result has taken out.
/// @param plain, models  the fits without a fault and with all that were found.
void JudgeRangeOffset(const BiasEstimate& range_offset,
                      const FaultFit& plain,
                      const FaultFit& models,
                      const DiagnosisOptions& options,
                      Diagnosis* diagnosis);

}  // namespace voqcal
