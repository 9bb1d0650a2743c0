#include "import/acfr_session.hpp"

#include <csignal>
#include <filesystem>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core/mat.hpp>
#include <sys/resource.h>

#include "images/jpeg.hpp"
#include "rig/rig.hpp"
#include "support/temporary_folder.hpp"

namespace voqcal {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::string CloudOf(int num_points) {
  const std::string num = std::to_string(num_points);
  std::string text = "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " +
                     num + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + num + "\nDATA ascii\n";
  for (int i = 0; i < num_points; ++i) text += "1 2 3\n";
  return text;
}

std::string ErrorOf(const std::filesystem::path& session, const std::filesystem::path& log) {
  const Rig rig;
  try {
    ImportAcfrSession(session, rig, AcfrImportOptions{}, log);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

/// No file of this process grows beyond so many bytes, as on a full disk.
class SmallDisk {
 public:
  explicit SmallDisk(rlim_t num_bytes) {
    std::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{num_bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;
  ~SmallDisk() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, SIG_DFL);
  }

 private:
  rlimit before_{};
};

TEST(ImportAcfrSession, DoubtsImagesOfAnotherSizeAndFramesThatAreToRest) {
  const test::TemporaryFolder folder;
  std::filesystem::create_directories(folder.path() / "pcd");
  std::filesystem::create_directories(folder.path() / "images");
  folder.Write("pcd/pose1_full.pcd", CloudOf(3));
  const auto jpeg = EncodeJpeg(cv::Mat(48, 64, CV_8UC1, cv::Scalar(128)), 90);
  folder.Write("images/pose1.jpg", {jpeg.begin(), jpeg.end()});
  Rig rig;
  rig.camera.width_px = 1280;
  rig.camera.height_px = 800;
  const auto import = [&] {
    return ImportAcfrSession(folder.path(), rig, AcfrImportOptions{}, folder.path() / "out.lcm")
        .doubts;
  };
  EXPECT_THAT(
      import(),
      ElementsAre(
          HasSubstr("images that are not of the camera's size: 1 (the first is of 64 x 48 px"),
          HasSubstr("num_still_frames is 3")));
  rig.camera.width_px = 64;
  rig.camera.height_px = 48;
  rig.sample_collector.num_still_frames = 1;
  EXPECT_THAT(import(), IsEmpty());
}

// A full disk is no fault of the cloud that did not fit.
TEST(ImportAcfrSession, EndsWhereTheLogCannotBeWritten) {
  const test::TemporaryFolder folder;
  std::filesystem::create_directories(folder.path() / "pcd");
  std::filesystem::create_directories(folder.path() / "images");
  constexpr int kMoreThanIsBuffered = 100'000;
  folder.Write("pcd/pose1_full.pcd", CloudOf(kMoreThanIsBuffered));
  const auto jpeg = EncodeJpeg(cv::Mat(48, 64, CV_8UC1, cv::Scalar(128)), 90);
  folder.Write("images/pose1.jpg", {jpeg.begin(), jpeg.end()});
  const std::filesystem::path log = folder.path() / "out.lcm";
  EXPECT_EQ(ErrorOf(folder.path(), log), "");
  std::filesystem::remove(log);
  const SmallDisk disk(100'000);
  EXPECT_THAT(ErrorOf(folder.path(), log), HasSubstr(log.string() + ": cannot write: "));
}

}  // namespace
}  // namespace voqcal
