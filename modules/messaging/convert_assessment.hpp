#pragma once

#include "core/assessment/diagnosis.hpp"
#include "core/assessment/predicted_error.hpp"
#include "core/assessment/score_bins.hpp"
#include "core/assessment/verdict.hpp"
#include "core/scene/scene_check.hpp"
#include "voqcal/finding_t.hpp"
#include "voqcal/predicted_error_t.hpp"
#include "voqcal/scene_check_t.hpp"
#include "voqcal/score_bin_t.hpp"
#include "voqcal/verdict_check_t.hpp"

namespace voqcal {

score_bin_t ToMessage(const ScoreBin& bin);
predicted_error_t ToMessage(const PredictedError& error);
scene_check_t ToMessage(const SceneCheck& check);
finding_t ToMessage(const Finding& finding);
verdict_check_t ToMessage(const VerdictCheck& check);

}  // namespace voqcal
