#include "core/camera_detection/charuco_opencv.hpp"

#include <opencv2/core/version.hpp>

#if CV_VERSION_MAJOR == 4 && CV_VERSION_MINOR < 7
#include <opencv2/aruco/charuco.hpp>
#else
#include <opencv2/objdetect/charuco_detector.hpp>
#endif

namespace voqcal {
namespace {

constexpr int kMinMarkers = 1;  // beside a corner that counts

}  // namespace

#if CV_VERSION_MAJOR == 4 && CV_VERSION_MINOR < 7

namespace {

cv::Ptr<cv::aruco::CharucoBoard> BoardOf(const CharucoLayout& layout) {
  return cv::aruco::CharucoBoard::create(layout.num_squares_x,
                                         layout.num_squares_y,
                                         layout.square_m,
                                         layout.marker_m,
                                         cv::aruco::getPredefinedDictionary(layout.dictionary));
}

}  // namespace

Markers DetectMarkers(const cv::Mat& grey, int dictionary) {
  Markers found;
  std::vector<std::vector<cv::Point2f>> rejected;
  cv::aruco::detectMarkers(grey,
                           cv::aruco::getPredefinedDictionary(dictionary),
                           found.corners_px,
                           found.ids,
                           cv::aruco::DetectorParameters::create(),
                           rejected);
  found.num_rejected = static_cast<int>(rejected.size());
  return found;
}

cv::Mat DrawMarker(int dictionary, int id, int num_cells_with_border) {
  cv::Mat image;
  cv::aruco::drawMarker(
      cv::aruco::getPredefinedDictionary(dictionary), id, num_cells_with_border, image);
  return image;
}

CharucoCorners CornersBesideMarkers(const cv::Mat& grey,
                                    const Markers& markers,
                                    const CharucoLayout& layout) {
  CharucoCorners found;
  cv::aruco::interpolateCornersCharuco(markers.corners_px,
                                       markers.ids,
                                       grey,
                                       BoardOf(layout),
                                       found.corners_px,
                                       found.ids,
                                       cv::noArray(),
                                       cv::noArray(),
                                       kMinMarkers);
  return found;
}

cv::Mat DrawCharucoLayout(const CharucoLayout& layout, cv::Size size_px) {
  cv::Mat image;
  BoardOf(layout)->draw(size_px, image);
  return image;
}

#else

namespace {

cv::aruco::CharucoBoard BoardOf(const CharucoLayout& layout) {
  return {{layout.num_squares_x, layout.num_squares_y},
          layout.square_m,
          layout.marker_m,
          cv::aruco::getPredefinedDictionary(layout.dictionary)};
}

}  // namespace

Markers DetectMarkers(const cv::Mat& grey, int dictionary) {
  Markers found;
  std::vector<std::vector<cv::Point2f>> rejected;
  const cv::aruco::ArucoDetector detector(cv::aruco::getPredefinedDictionary(dictionary));
  detector.detectMarkers(grey, found.corners_px, found.ids, rejected);
  found.num_rejected = static_cast<int>(rejected.size());
  return found;
}

cv::Mat DrawMarker(int dictionary, int id, int num_cells_with_border) {
  cv::Mat image;
  cv::aruco::generateImageMarker(
      cv::aruco::getPredefinedDictionary(dictionary), id, num_cells_with_border, image);
  return image;
}

CharucoCorners CornersBesideMarkers(const cv::Mat& grey,
                                    const Markers& markers,
                                    const CharucoLayout& layout) {
  cv::aruco::CharucoParameters parameters;
  parameters.minMarkers = kMinMarkers;
  // It looks for markers only where it is given none.
  std::vector<std::vector<cv::Point2f>> corners_px = markers.corners_px;
  std::vector<int> ids = markers.ids;
  CharucoCorners found;
  cv::aruco::CharucoDetector(BoardOf(layout), parameters)
      .detectBoard(grey, found.corners_px, found.ids, corners_px, ids);
  return found;
}

cv::Mat DrawCharucoLayout(const CharucoLayout& layout, cv::Size size_px) {
  cv::Mat image;
  BoardOf(layout).generateImage(size_px, image);
  return image;
}

#endif

}  // namespace voqcal
