#include "dashboard/access.hpp"

#include <fstream>
#include <set>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "files/atomic_file.hpp"
#include "support/temporary_folder.hpp"

namespace voqcal {
namespace {

std::string AddressOf(const std::string& token) { return "http://127.0.0.1:8765/" + token + "/"; }

TEST(NewToken, Is64DigitsAndNeverTheSame) {
  std::set<std::string> tokens;
  for (int i = 0; i < 20; ++i) {
    const std::string token = NewToken();
    EXPECT_EQ(token.size(), 64U);
    EXPECT_EQ(token.find_first_not_of("0123456789abcdef"), std::string::npos) << token;
    tokens.insert(token);
  }
  EXPECT_EQ(tokens.size(), 20U);
}

TEST(SaveAddresses, LetsOnlyItsOwnerReadIt) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "url.txt";
  for (const char* address : {"http://a/", "http://b/"}) {
    SaveAddresses(file, address);
    EXPECT_EQ(ReadWholeFile(file), std::string(address) + "\n");
    struct stat status {};
    ASSERT_EQ(stat(file.c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777U, 0600U);
  }
}

TEST(TokenOfSession, IsKeptWhereOnlyItsOwnerSawIt) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "url.txt";
  const std::string token = TokenOfSession(file);
  SaveAddresses(file, AddressOf(token));
  EXPECT_EQ(TokenOfSession(file), token);
  ASSERT_EQ(chmod(file.c_str(), 0644), 0);
  EXPECT_NE(TokenOfSession(file), token);
}

TEST(TokenOfSession, IsNewWhereTheFileHoldsNone) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "url.txt";
  for (const std::string& text : {std::string(),
                                  std::string("/"),
                                  AddressOf("short"),
                                  std::string(200, '/'),
                                  AddressOf(std::string(64, 'x'))}) {
    SaveAddresses(file, text);
    EXPECT_EQ(TokenOfSession(file).size(), 64U) << text;
    EXPECT_NE(AddressOf(TokenOfSession(file)), text);
  }
}

TEST(IsSameSecret, IsEquality) {
  EXPECT_TRUE(IsSameSecret("abc", "abc"));
  EXPECT_FALSE(IsSameSecret("abc", "abd"));
  EXPECT_FALSE(IsSameSecret("abc", "ab"));
  EXPECT_FALSE(IsSameSecret("", "abc"));
}

TEST(IsOwnHost, TakesAddressesLocalhostAndTheRigsName) {
  for (const char* host : {"127.0.0.1",
                           "127.0.0.1:8765",
                           "192.168.1.7:80",
                           "[::1]:8765",
                           "[fe80::1]",
                           "localhost",
                           "localhost:9000",
                           "cart.local:8765"}) {
    EXPECT_TRUE(IsOwnHost(host, "cart.local")) << host;
  }
}

TEST(IsOwnHost, TakesNamesInEitherCase) {
  EXPECT_TRUE(IsOwnHost("cart.local:8765", "Cart.LOCAL"));
  EXPECT_TRUE(IsOwnHost("CART.local:8765", "cart.local"));
  EXPECT_TRUE(IsOwnHost("LocalHost:8765", ""));
}

TEST(IsOwnHost, RefusesOtherNames) {
  for (const char* host : {"",
                           ":8765",
                           "example.org",
                           "example.org:8765",
                           "127.0.0.1.example.org",
                           "localhost.example.org",
                           "cart.local.example.org",
                           "[::1",
                           "127.0.0.1 "}) {
    EXPECT_FALSE(IsOwnHost(host, "cart.local")) << host;
    EXPECT_FALSE(IsOwnHost(host, "")) << host;
  }
}

TEST(IsOwnOrigin, IsThePageOfThisHostAndPort) {
  EXPECT_TRUE(IsOwnOrigin("http://127.0.0.1:8765", "127.0.0.1:8765"));
  for (const char* origin : {"",
                             "null",
                             "http://",
                             "http://127.0.0.1",
                             "http://127.0.0.1:8766",
                             "https://127.0.0.1:8765",
                             "http://localhost:8765",
                             "http://127.0.0.1:8765.example.org",
                             "http://127.0.0.1:8765/"}) {
    EXPECT_FALSE(IsOwnOrigin(origin, "127.0.0.1:8765")) << origin;
  }
}

}  // namespace
}  // namespace voqcal
