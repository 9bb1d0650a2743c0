#include "result/verdict_yaml.hpp"

#include "result/assessment_yaml.hpp"

namespace voqcal {

std::string VerdictYaml(const Verdict& verdict) {
  std::string text =
      "verdict:\n"
      "  grade: " +
      ToString(verdict.grade) +
      "  # the worst of the checks: good; look: usable, read why; bad: do not use\n"
      "  headline: " +
      QuotedYaml(verdict.headline) + "\n  checks:\n";
  for (const VerdictCheck& check : verdict.checks) {
    text += "    - {name: " + QuotedYaml(check.name) + ", grade: " + ToString(check.grade) +
            ", text: " + QuotedYaml(check.text) + "}\n";
  }
  return text;
}

}  // namespace voqcal
