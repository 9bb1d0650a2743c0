#include "core/assessment/verdict.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>

#include "core/assessment/judged_result.hpp"
#include "core/camera/image_parts.hpp"
#include "core/units.hpp"

namespace voqcal {
namespace {

constexpr const char* kRangeCause = "lidar range offset";  // a finding's

/// Good up to the first, bad beyond the second; where more is better, the other way round.
struct Limits {
  double good;
  double bad;
};

constexpr Limits kHeldOutMm{5.0, 12.0};    // the method's paper reports means of 10 to 12 mm
constexpr Limits kOverfitRatio{1.5, 3.0};  // 1.1 is common with 30 poses
constexpr Limits kSigmaDeg{0.05, 0.2};     // 0.05 degrees is 9 mm at 10 m
constexpr Limits kSigmaMm{3.0, 5.0};       // 95 in 100 are within twice as much: 10 mm
constexpr Limits kNormalDeg{0.7, 2.0};     // a clean simulated VLP-16 shows about 0.6
constexpr Limits kTurnDeg{kDegPerRad * kMostCameraTurnRad, 2.0};
constexpr int kFewestPoses = 6;
constexpr Limits kNumImagePartsSeen{5, 2};  // of 9
constexpr Limits kLeftOutShare{0.15, 0.4};

Grade GradeOf(double value, const Limits& limits) {
  const double sign = limits.good <= limits.bad ? 1.0 : -1.0;
  if (sign * value <= sign * limits.good) return Grade::kGood;
  return sign * value > sign * limits.bad ? Grade::kBad : Grade::kLook;
}

std::string Number(double value, int digits, const std::string& unit) {
  char text[64];
  std::snprintf(text, sizeof(text), "%.*f ", digits, value);
  return text + unit;
}

std::string Sentence(std::string text) {
  if (text.empty()) return text;
  text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text.back() == '.' ? text : text + ".";
}

/// `advice` is for who has to do something: not where all is good.
void Add(const std::string& name,
         Grade grade,
         const std::string& fact,
         const std::string& advice,
         std::vector<VerdictCheck>* checks) {
  checks->push_back({name, grade, grade == Grade::kGood ? fact : fact + " " + advice});
}

/// What is not known tells nothing of causes.
void AddNumber(const std::string& name,
               double value,
               const Limits& limits,
               const std::string& fact,
               const std::string& advice,
               std::vector<VerdictCheck>* checks) {
  if (std::isnan(value)) {
    checks->push_back(
        {name, Grade::kLook, "Unknown: no pose could be held out to tell. Take more samples."});
    return;
  }
  Add(name, GradeOf(value, limits), fact, advice, checks);
}

void AddFit(const Evidence& evidence, std::vector<VerdictCheck>* checks) {
  const double ratio = evidence.held_out_mm / evidence.in_sample_mm;
  AddNumber(
      "Poses it never saw",
      evidence.held_out_mm,
      kHeldOutMm,
      "The board's centre lands " + Number(evidence.held_out_mm, 1, "mm") +
          " (mean) from where the camera sees it, on poses left out of the fit.",
      "If a few poses stand out, discard them; if most are off, check the board and the camera in "
      "the rig file.",
      checks);
  AddNumber("Poses it was made from",
            ratio,
            kOverfitRatio,
            "Left out of the fit they err " + Number(ratio, 2, "times") + " as much as in it.",
            "The result fits these too well: take more samples.",
            checks);
  AddNumber(
      "Board directions",
      evidence.normal_deg,
      kNormalDeg,
      "Lidar and camera disagree by " + Number(evidence.normal_deg, 2, "degrees") +
          " (mean) on where the board faces.",
      evidence.likeliest_cause == kRangeCause
          ? "The lidar's ranges are probably biased, which the centres do not show: take more "
            "samples, tilted to all sides."
          : "Something that the centres do not show is wrong: the board's size, the camera's "
            "intrinsics or the lidar's ranges. Check board and camera in the rig file.",
      checks);
}

/// What may come of a wrong input that was found is not put down to whoever held the board.
std::string RemedyAfterCause(const Evidence& evidence, const std::string& otherwise) {
  if (evidence.must_be_mended && !evidence.likeliest_fault.empty()) {
    return "First mend what may be why: " + evidence.likeliest_cause + ".";
  }
  if (!evidence.other_lens.empty()) {
    return "First calibrate the lens, which may be why (calibrate_lens).";
  }
  return otherwise;
}

/// What was taken out of the directions, so that they do not show it.
void AddChessboardTurn(const Evidence& evidence, std::vector<VerdictCheck>* checks) {
  if (evidence.chessboard_turn_deg == 0.0) return;
  AddNumber(
      "Boards and rays",
      evidence.chessboard_turn_deg,
      kTurnDeg,
      "All chessboards are turned by " + Number(evidence.chessboard_turn_deg, 2, "degrees") +
          " against the rays to them, as by a principal point or scan lines that are off. This was "
          "taken out.",
      RemedyAfterCause(evidence,
                       "Check camera.cx_px and cy_px in the rig file (calibrate_lens finds them), "
                       "and the lidar's own calibration."),
      checks);
}

void AddCertainty(const Evidence& evidence, std::vector<VerdictCheck>* checks) {
  AddNumber("Certainty of the rotation",
            evidence.sigma_deg,
            kSigmaDeg,
            "Largest standard deviation in this camera's image " +
                Number(evidence.sigma_deg, 3, "degrees") +
                " (good: " + Number(kSigmaDeg.good, 3, "at most") + ").",
            "Take more samples, far to the left and right and high and low.",
            checks);
  AddNumber("Certainty of the translation",
            evidence.sigma_mm,
            kSigmaMm,
            "Standard deviation in this camera's image " + Number(evidence.sigma_mm, 1, "mm") +
                ", the three axes' together (good: " + Number(kSigmaMm.good, 1, "at most") + ").",
            "Take more samples, near ones too, tilted to all sides.",
            checks);
}

void AddParts(const std::vector<std::string>& empty, std::vector<VerdictCheck>* checks) {
  const std::size_t num_seen = kNumImageParts - empty.size();
  std::string none;
  for (const std::string& part : empty) none += (none.empty() ? "; none: " : ", ") + part;
  Add("Parts of the image",
      GradeOf(static_cast<double>(num_seen), kNumImagePartsSeen),
      std::to_string(num_seen) + " of the 9 parts of the image have a pose" + none + ".",
      "Show the board there too: the result is extrapolated.",
      checks);
}

void AddPoses(const Evidence& evidence, std::vector<VerdictCheck>* checks) {
  const int num_left_out = evidence.num_samples - evidence.num_used;
  Add("Number of poses",
      evidence.num_used < kFewestPoses ? Grade::kBad
      : evidence.is_enough             ? Grade::kGood
                                       : Grade::kLook,
      std::to_string(evidence.num_used) + " poses were used. " + evidence.enough_words,
      "Take more: near and far, to all sides, tilted each way.",
      checks);
  AddParts(evidence.empty_parts, checks);
  Add("Samples left out",
      GradeOf(static_cast<double>(num_left_out) / std::max(evidence.num_samples, 1), kLeftOutShare),
      std::to_string(num_left_out) + " of " + std::to_string(evidence.num_samples) +
          " samples disagreed with the others and were left out.",
      RemedyAfterCause(evidence, "Hold the board still, away from people and things of its size."),
      checks);
}

/// A lens that fits better is no fault of an extrinsic that goes with the one that was given.
void AddLens(const Evidence& evidence, std::vector<VerdictCheck>* checks) {
  if (evidence.other_lens.empty()) return;
  Add("The lens",
      Grade::kLook,
      Sentence(evidence.other_lens),
      "Use the result with the rig file's lens only. To do better, calibrate the lens "
      "(calibrate_lens), put it into the rig file, and calibrate again.",
      checks);
}

/// A cause that makes the result wrong comes before all that it may have led to.
void AddCause(const Evidence& evidence, std::vector<VerdictCheck>* checks) {
  const std::string& fault = evidence.likeliest_fault;
  const Grade grade = fault.empty()             ? Grade::kGood
                      : evidence.must_be_mended ? Grade::kBad
                                                : Grade::kLook;
  std::string text = "Nothing was found that would explain the errors better.";
  if (!evidence.other_lens.empty())
    text = "But for the lens nothing was found that would explain the errors better.";
  if (!fault.empty()) text = Sentence(fault);
  checks->insert(grade == Grade::kBad ? checks->begin() : checks->end(),
                 {"Signs of a fault", grade, text});
}

/// The scene's own word, where it has one.
void AddScene(const Evidence& evidence, std::vector<VerdictCheck>* checks) {
  if (evidence.scene != Agreement::kCannotTell) {
    Add("The whole scene",
        evidence.scene == Agreement::kAgrees ? Grade::kGood : Grade::kBad,
        Sentence(evidence.scene_reason),
        "The scene contradicts the board: check the board and the camera in the rig file, and that "
        "neither sensor was moved.",
        checks);
  }
}

std::string Headline(Grade grade, const Evidence& evidence) {
  switch (grade) {
    case Grade::kGood:
      return "Good: use it. Nothing is to be done.";
    case Grade::kLook:
      return "Usable; what is marked below would make it better.";
    case Grade::kBad:
      break;
  }
  if (evidence.must_be_mended)
    return "Do not use it: first mend the " + evidence.likeliest_cause + ".";
  return "Do not use it yet: mend what is marked below.";
}

}  // namespace

std::string ToString(Grade grade) {
  switch (grade) {
    case Grade::kGood:
      return "good";
    case Grade::kLook:
      return "look";
    case Grade::kBad:
      break;
  }
  return "bad";
}

Verdict VerdictOf(const Evidence& evidence) {
  Verdict verdict;
  AddFit(evidence, &verdict.checks);
  AddChessboardTurn(evidence, &verdict.checks);
  AddCertainty(evidence, &verdict.checks);
  AddPoses(evidence, &verdict.checks);
  AddScene(evidence, &verdict.checks);
  AddLens(evidence, &verdict.checks);
  AddCause(evidence, &verdict.checks);
  verdict.grade = std::max_element(verdict.checks.begin(),
                                   verdict.checks.end(),
                                   [](const VerdictCheck& a, const VerdictCheck& b) {
                                     return a.grade < b.grade;
                                   })
                      ->grade;
  verdict.headline = Headline(verdict.grade, evidence);
  return verdict;
}

}  // namespace voqcal
