#include "files/option_section.hpp"

#include <string>
#include <type_traits>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/units.hpp"
#include "support/temporary_folder.hpp"

namespace voqcal {
namespace {

using testing::HasSubstr;

template <typename Section, typename = void>
struct ReadsWithoutMeaning : std::false_type {};
template <typename Section>
struct ReadsWithoutMeaning<
    Section,
    std::void_t<decltype(std::declval<Section>().Read("key", std::declval<double*>()))>>
    : std::true_type {};

TEST(OptionSection, DemandsAMeaning) {
  EXPECT_TRUE(ReadsWithoutMeaning<YamlSection>());
  EXPECT_FALSE(ReadsWithoutMeaning<OptionSection>());
}

TEST(OptionSection, KnowsTextThatReadsBackAsTheSame) {
  for (const std::string text :
       {"", "word", "two words", "a # b", "say \"hi\" \\ {x: [1]}", "- "}) {
    YamlDocument document("a.yaml", "key: " + YamlText(text));
    std::string read;
    YamlSection(&document).Read("key", &read);
    document.ThrowIfWrong();
    EXPECT_EQ(read, text);
  }
  EXPECT_EQ(YamlText(-0.0005), "-0.0005");
  EXPECT_EQ(YamlText(10.0), "10");
  EXPECT_EQ(YamlText(std::vector<double>{}), "[]");
}

YamlDocument::KnownKey DegreesOf(double value_rad) {
  YamlDocument document("a.yaml", "{}");
  OptionSection(&document).ReadDegrees("turn_deg", &value_rad, "a turn");
  return document.known_keys().at(0);
}

// What is shown as the default reads as the default, to the last bit.
TEST(OptionSection, ShowsAnglesThatItRoundsAsExamples) {
  EXPECT_EQ(DegreesOf(0.05).value, "2.865");
  EXPECT_TRUE(DegreesOf(0.05).is_example);
  EXPECT_EQ(DegreesOf(-15 * kRadPerDeg).value, "-15");
  EXPECT_FALSE(DegreesOf(-15 * kRadPerDeg).is_example);
}

TEST(OptionSection, ReadsOneOfSomeWords) {
  const std::vector<std::pair<std::string, int>> words = {{"one", 1}, {"two", 2}, {"three", 3}};
  const auto read = [&words](const std::string& text, int* value) {
    YamlDocument document("a.yaml", text);
    OptionSection(&document).ReadOneOf("key", words, value, "how many");
    EXPECT_EQ(document.known_keys().at(0).meaning, "how many: one, two or three");
    document.ThrowIfWrong();
  };
  int value = 2;
  read("{}", &value);
  EXPECT_EQ(value, 2);
  read("key: three", &value);
  EXPECT_EQ(value, 3);
  EXPECT_THAT(test::ErrorOf([&] { read("key: four", &value); }),
              HasSubstr("a.yaml:1: key must be one, two or three, is \"four\""));
}

TEST(DocumentedYaml, HasShortCommentsBesideTheKeysAndLongOnesAbove) {
  const std::string word = "a_word_of_25_letters_here ";
  const std::string four = word + word + word + word;
  EXPECT_EQ(
      DocumentedYaml({{"section", "", "what it is"},
                      {"section.short_m", "0.5", "so far"},
                      {"section.example_deg", "2.865", "an angle", true},
                      {"section.wrapped", "1", word + word + word},
                      {"section.long", "1", four + four},
                      {"section.drawn", "1", "Seen so:\n  +---+   is kept\nand no other way"},
                      {"section.part", "", "a part"},
                      {"section.part.url_of_it", "\"udpm://239.255.76.67:7667?ttl=0\"", "where"}}),
      R"(
section:                          # what it is
  short_m: 0.5                    # so far
  # example_deg: 2.865            # an angle
  wrapped: 1                      # a_word_of_25_letters_here a_word_of_25_letters_here
                                  # a_word_of_25_letters_here
  # a_word_of_25_letters_here a_word_of_25_letters_here a_word_of_25_letters_here
  # a_word_of_25_letters_here a_word_of_25_letters_here a_word_of_25_letters_here
  # a_word_of_25_letters_here a_word_of_25_letters_here
  long: 1
  # Seen so:
  #   +---+   is kept
  # and no other way
  drawn: 1
  part:                           # a part
    # where
    url_of_it: "udpm://239.255.76.67:7667?ttl=0"
)");
}

}  // namespace
}  // namespace voqcal
