#include "rig_status/table_of_pairs.hpp"

#include <algorithm>
#include <cmath>

#include "core/format.hpp"
#include "core/units.hpp"

namespace voqcal {
namespace {

std::string SigmaText(const rig_pair_t& pair) {
  if (std::isnan(pair.sigma_rad)) return "                     ";
  return Format("%6.3f deg %7.1f mm", kDegPerRad * pair.sigma_rad, 1e3 * pair.sigma_m);
}

std::string VerdictText(const rig_pair_t& pair) {
  if (!pair.has_session) return "two cameras, by the boards that both saw";
  if (!pair.problem.empty()) return pair.problem;
  return pair.verdict_grade + ": " + pair.verdict_headline;
}

}  // namespace

std::string TableOfPairs(const rig_extrinsics_t& rig) {
  std::size_t width = 8;
  for (const rig_pair_t& pair : rig.pairs) width = std::max(width, pair.name.size());
  const int name_width = static_cast<int>(width);
  std::string text = Format("%-*s samples  1 sigma in the tree   verdict\n", name_width, "pair");
  for (const rig_pair_t& pair : rig.pairs) {
    text += Format("%-*s %7d  %s  %s%s\n",
                   name_width,
                   pair.name.c_str(),
                   pair.num_samples,
                   SigmaText(pair).c_str(),
                   VerdictText(pair).c_str(),
                   pair.name == rig.weakest_pair ? " (next)" : "");
  }
  text += rig.problem.empty() ? "rig     " + rig.verdict_headline + "\n"
                              : "rig     no tree yet: " + rig.problem + "\n";
  return rig.advice.empty() ? text : text + "next    " + rig.advice + "\n";
}

}  // namespace voqcal
