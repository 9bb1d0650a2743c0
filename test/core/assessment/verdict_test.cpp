#include "core/assessment/verdict.hpp"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace voqcal {
namespace {

using ::testing::Contains;
using ::testing::Field;
using ::testing::HasSubstr;

/// Of a session without anything to complain of.
Evidence GoodEvidence() {
  Evidence evidence;
  evidence.held_out_mm = 2.3;
  evidence.in_sample_mm = 2.1;
  evidence.normal_deg = 0.6;
  evidence.sigma_deg = 0.02;
  evidence.sigma_mm = 1.0;
  evidence.num_used = 30;
  evidence.is_enough = true;
  evidence.enough_words = "Enough: 4.2 mm at worst, at 5 m; 5 mm are asked.";
  evidence.num_samples = 31;
  evidence.empty_parts = {"bottom left", "bottom right"};
  evidence.scene = Agreement::kAgrees;
  evidence.scene_reason = "the edges fit best 0.05 deg from it";
  return evidence;
}

template <typename Change>
Verdict JudgeWith(const Change& change) {
  Evidence evidence = GoodEvidence();
  change(&evidence);
  return VerdictOf(evidence);
}

TEST(VerdictOf, IsGoodWhereAllIs) {
  const Verdict verdict = VerdictOf(GoodEvidence());
  EXPECT_EQ(verdict.grade, Grade::kGood);
  EXPECT_THAT(verdict.headline, HasSubstr("use it"));
  for (const VerdictCheck& check : verdict.checks)
    EXPECT_EQ(check.grade, Grade::kGood) << check.name;
}

TEST(VerdictOf, IsAsBadAsItsWorstCheck) {
  EXPECT_EQ(JudgeWith([](Evidence* e) { e->held_out_mm = 5.1; }).grade, Grade::kLook);
  EXPECT_EQ(JudgeWith([](Evidence* e) { e->held_out_mm = 12.1; }).grade, Grade::kBad);
  EXPECT_EQ(JudgeWith([](Evidence* e) { e->in_sample_mm = 0.5; }).grade, Grade::kBad);
  EXPECT_EQ(JudgeWith([](Evidence* e) { e->normal_deg = 0.8; }).grade, Grade::kLook);
  EXPECT_EQ(JudgeWith([](Evidence* e) { e->chessboard_turn_deg = 0.6; }).grade, Grade::kGood);
  EXPECT_EQ(JudgeWith([](Evidence* e) { e->chessboard_turn_deg = 0.8; }).grade, Grade::kLook);
  EXPECT_EQ(JudgeWith([](Evidence* e) { e->chessboard_turn_deg = 2.1; }).grade, Grade::kBad);
  EXPECT_EQ(JudgeWith([](Evidence* e) { e->sigma_deg = 0.3; }).grade, Grade::kBad);
  EXPECT_EQ(JudgeWith([](Evidence* e) { e->sigma_mm = 5; }).grade, Grade::kLook);
  EXPECT_EQ(JudgeWith([](Evidence* e) { e->num_samples = 40; }).grade, Grade::kLook);
  EXPECT_EQ(JudgeWith([](Evidence* e) { e->likeliest_fault = "a fault"; }).grade, Grade::kLook);
  EXPECT_EQ(JudgeWith([](Evidence* e) { e->scene = Agreement::kDisagrees; }).grade, Grade::kBad);
}

std::string TextOf(const Verdict& verdict, const std::string& check) {
  for (const VerdictCheck& each : verdict.checks) {
    if (each.name == check) return each.text;
  }
  return "no such check";
}

TEST(VerdictOf, BlamesNobodyForWhatACauseMayHaveDone) {
  const auto left_out = [](Evidence* e) {
    e->num_samples = 40;
    e->chessboard_turn_deg = 1.5;
  };
  const Verdict without = JudgeWith(left_out);
  EXPECT_THAT(TextOf(without, "Samples left out"), HasSubstr("Hold the board still"));
  EXPECT_THAT(TextOf(without, "Boards and rays"), HasSubstr("cx_px"));
  const Verdict by_cause = JudgeWith([&](Evidence* e) {
    left_out(e);
    e->likeliest_fault = "the squares are 2 % larger";
    e->likeliest_cause = "board's squares";
    e->must_be_mended = true;
  });
  const Verdict by_lens = JudgeWith([&](Evidence* e) {
    left_out(e);
    e->other_lens = "the samples ask for another lens";
  });
  for (const char* check : {"Samples left out", "Boards and rays"}) {
    EXPECT_THAT(TextOf(by_cause, check), HasSubstr("First mend what may be why: board's squares."));
    EXPECT_THAT(TextOf(by_lens, check), HasSubstr("First calibrate the lens"));
  }
  // A board that moved is no input to mend.
  const Verdict by_motion = JudgeWith([&](Evidence* e) {
    left_out(e);
    e->likeliest_fault = "sample 7 moved";
    e->likeliest_cause = "moving sample";
  });
  EXPECT_THAT(TextOf(by_motion, "Samples left out"), HasSubstr("Hold the board still"));
}

TEST(VerdictOf, IsBadByACauseThatMustBeMendedWhichComesFirst) {
  const Verdict verdict = JudgeWith([](Evidence* e) {
    e->likeliest_fault = "the true fx is 2 % longer";
    e->likeliest_cause = "focal length fx";
    e->must_be_mended = true;
  });
  EXPECT_EQ(verdict.grade, Grade::kBad);
  EXPECT_THAT(verdict.headline, HasSubstr("first mend the focal length fx"));
  EXPECT_EQ(verdict.checks.front().text, "The true fx is 2 % longer.");
}

TEST(VerdictOf, SuspectsTheRangesOnlyWhereTheirOffsetIsTheCause) {
  const auto text_with = [](const std::string& cause) {
    const Verdict verdict = JudgeWith([&cause](Evidence* e) {
      e->normal_deg = 1.5;
      e->likeliest_fault = "a fault";
      e->likeliest_cause = cause;
    });
    for (const VerdictCheck& check : verdict.checks) {
      if (check.name == "Board directions") return check.text;
    }
    return std::string();
  };
  EXPECT_THAT(text_with("lidar range offset"), HasSubstr("ranges are probably biased"));
  EXPECT_THAT(text_with("distortion"), testing::Not(HasSubstr("probably biased")));
}

TEST(VerdictOf, WantsMoreOfPosesAndParts) {
  const auto with_poses = [](int num, bool is_enough) {
    return JudgeWith([=](Evidence* e) {
             e->num_used = e->num_samples = num;
             e->is_enough = is_enough;
           })
        .grade;
  };
  EXPECT_EQ(with_poses(8, true), Grade::kGood);
  EXPECT_EQ(with_poses(30, false), Grade::kLook);
  EXPECT_EQ(with_poses(5, false), Grade::kBad);
  EXPECT_THAT(
      VerdictOf(GoodEvidence()).checks,
      Contains(Field(&VerdictCheck::text, HasSubstr("; none: bottom left, bottom right."))));
  const auto without_parts = [](std::size_t num) {
    return JudgeWith([num](Evidence* e) { e->empty_parts.assign(num, "top"); }).grade;
  };
  EXPECT_EQ(without_parts(4), Grade::kGood);
  EXPECT_EQ(without_parts(5), Grade::kLook);
  EXPECT_EQ(without_parts(8), Grade::kBad);
}

TEST(VerdictOf, LooksAtALensThatFitsBetter) {
  const Verdict verdict =
      JudgeWith([](Evidence* e) { e->other_lens = "the samples ask for another lens"; });
  EXPECT_EQ(verdict.grade, Grade::kLook);
  EXPECT_THAT(
      verdict.checks,
      Contains(Field(&VerdictCheck::text, HasSubstr("But for the lens nothing was found"))));
}

TEST(VerdictOf, DoesNotCallTheUnknownGood) {
  const Verdict verdict = VerdictOf(Evidence{});
  EXPECT_EQ(verdict.grade, Grade::kBad);  // no poses
  int num_unknown = 0;
  for (const VerdictCheck& check : verdict.checks) {
    if (check.text != "Unknown: no pose could be held out to tell. Take more samples.") continue;
    EXPECT_EQ(check.grade, Grade::kLook) << check.name;
    ++num_unknown;
  }
  EXPECT_EQ(num_unknown, 5);
}

TEST(VerdictOf, SaysWhatToDoUnlessItIsGood) {
  const auto text_of = [](const Verdict& verdict, const std::string& name) {
    for (const VerdictCheck& check : verdict.checks) {
      if (check.name == name) return check.text;
    }
    return std::string();
  };
  EXPECT_EQ(text_of(VerdictOf(GoodEvidence()), "Number of poses"),
            "30 poses were used. Enough: 4.2 mm at worst, at 5 m; 5 mm are asked.");
  const auto not_enough = [](Evidence* e) {
    e->num_used = 10;
    e->is_enough = false;
    e->enough_words = "Not enough yet: 6 mm at worst, at 5 m; 5 mm are asked.";
  };
  EXPECT_EQ(text_of(JudgeWith(not_enough), "Number of poses"),
            "10 poses were used. Not enough yet: 6 mm at worst, at 5 m; 5 mm are asked. Take more: "
            "near and far, to all sides, tilted each way.");
}

TEST(VerdictOf, LeavesOutASceneThatSaysNothing) {
  const std::size_t num = VerdictOf(GoodEvidence()).checks.size();
  EXPECT_EQ(JudgeWith([](Evidence* e) { e->scene = Agreement::kCannotTell; }).checks.size(),
            num - 1);
}

TEST(VerdictOf, SpeaksInSentences) {
  const Verdict verdict =
      JudgeWith([](Evidence* e) { e->likeliest_fault = "the focal length is off"; });
  for (const VerdictCheck& check : verdict.checks) {
    EXPECT_EQ(check.text.back(), '.') << check.text;
    EXPECT_FALSE(check.text[0] >= 'a' && check.text[0] <= 'z') << check.text;
  }
}

}  // namespace
}  // namespace voqcal
