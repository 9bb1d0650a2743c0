#pragma once

#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace voqcal {

/// Gathers the constraints that a set of values breaks: one line each, with the value.
class ProblemList {
 public:
  /// Adds "RULE, is VALUE" unless the rule is met.
  template <typename Value>
  void Require(bool is_met, const std::string& rule, const Value& value) {
    if (is_met) return;
    std::ostringstream text;
    text << rule << ", is " << value;
    lines_.push_back(text.str());
  }

  /// NaN is not positive.
  template <typename Value>
  void RequirePositive(const std::string& name, const Value& value) {
    Require(value > 0, name + " must be positive", value);
  }

  /// The problems of a part, each after `prefix`.
  void Add(const std::vector<std::string>& problems, const std::string& prefix = {}) {
    for (const std::string& problem : problems) lines_.push_back(prefix + problem);
  }

  bool empty() const { return lines_.empty(); }
  const std::vector<std::string>& lines() const { return lines_; }

 private:
  std::vector<std::string> lines_;
};

/// @throws std::invalid_argument "WHAT: PROBLEM; PROBLEM ..." if there is any problem.
inline void RequireUsable(const std::string& what, const std::vector<std::string>& problems) {
  if (problems.empty()) return;
  std::string text = what;
  for (std::size_t i = 0; i < problems.size(); ++i) text += (i == 0 ? ": " : "; ") + problems[i];
  throw std::invalid_argument(text);
}

}  // namespace voqcal
