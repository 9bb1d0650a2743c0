#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <cairo.h>

#include "print_board/sheet_plan.hpp"

namespace voqcal {

/// What a file of drawn pages is.
enum class PageFormat { kPdf, kSvg };

/// Pages that are drawn in mm, from the upper left corner, and kept as the bytes of a file: the
/// same drawing gives the same bytes.
class Canvas {
 public:
  explicit Canvas(PageFormat format);
  Canvas(const Canvas&) = delete;
  Canvas& operator=(const Canvas&) = delete;

  /// The next page. An SVG has one.
  void BeginPage(double width_mm, double height_mm);

  /// All at once, so that neighbours have no seam. Nothing is drawn beyond `clip`.
  void FillRectangles(const std::vector<RectangleMm>& rectangles, const RectangleMm& clip);
  void Line(double from_x_mm, double from_y_mm, double to_x_mm, double to_y_mm, double width_mm);
  void Outline(const RectangleMm& rectangle, double width_mm);

  /// @param y_mm  of the base line.
  void Text(double x_mm, double y_mm, double size_mm, const std::string& text);
  void FixedWidthText(double x_mm, double y_mm, double size_mm, const std::string& text);
  /// Around `x_mm`.
  void CentredText(double x_mm, double y_mm, double size_mm, const std::string& text);

  /// Draws with the origin at (x_mm, y_mm), everything so many times as large.
  void DrawAt(double x_mm, double y_mm, double scale, const std::function<void()>& draw);

  /// @throws std::runtime_error if anything went wrong on the way.
  std::string Finish();

 private:
  void ShowText(const char* family, double size_mm, const std::string& text);

  PageFormat format_;
  std::string bytes_;
  std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)> surface_{
      nullptr, cairo_surface_destroy};
  std::unique_ptr<cairo_t, decltype(&cairo_destroy)> cairo_{nullptr, cairo_destroy};
};

}  // namespace voqcal
