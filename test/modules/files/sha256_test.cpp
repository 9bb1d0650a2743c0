#include "files/sha256.hpp"

#include <gtest/gtest.h>

#include "support/temporary_folder.hpp"

namespace voqcal {
namespace {

// The examples of FIPS 180-2, appendix B, and the empty message.
TEST(Sha256OfBytes, GivesThePublishedDigests) {
  EXPECT_EQ(Sha256OfBytes(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(Sha256OfBytes("abc"),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(Sha256OfBytes("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(Sha256OfBytes(std::string(1000000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, IsThatOfAllThatWasAddedSoFar) {
  Sha256 hash;
  EXPECT_EQ(hash.Hex(), Sha256OfBytes(""));
  hash.Add("ab", 2);
  EXPECT_EQ(hash.Hex(), Sha256OfBytes("ab"));
  hash.Add("c", 1);
  EXPECT_EQ(hash.Hex(), Sha256OfBytes("abc"));
}

TEST(Sha256OfFile, IsThatOfItsBytes) {
  const test::TemporaryFolder folder;
  const std::string bytes(200001, 'x');  // several pieces, the last one short
  EXPECT_EQ(Sha256OfFile(folder.Write("file", bytes)), Sha256OfBytes(bytes));
}

TEST(Sha256OfFile, NamesAFileThatCannotBeRead) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(test::ErrorOf([&] { Sha256OfFile(folder.path() / "none"); }),
            (folder.path() / "none").string() + ": cannot be read: No such file or directory");
  EXPECT_NE(test::ErrorOf([&] { Sha256OfFile(folder.path()); }), "");
}

}  // namespace
}  // namespace voqcal
