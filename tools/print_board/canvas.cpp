#include "print_board/canvas.hpp"

#include <functional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <cairo.h>

namespace voqcal {
namespace {

constexpr double kPointsPerMm = 72 / 25.4;

cairo_status_t Append(void* bytes, const unsigned char* data, unsigned int length) {
  static_cast<std::string*>(bytes)->append(reinterpret_cast<const char*>(data), length);
  return CAIRO_STATUS_SUCCESS;
}

cairo_surface_t* MakeSurface(PageFormat format,
                             double width_mm,
                             double height_mm,
                             std::string* bytes) {
  const double width_pt = width_mm * kPointsPerMm;
  const double height_pt = height_mm * kPointsPerMm;
  if (format == PageFormat::kSvg) {
    cairo_surface_t* surface =
        cairo_svg_surface_create_for_stream(Append, bytes, width_pt, height_pt);
    // Said, as 1.16 and 1.18 differ in what they take a number without unit for.
    cairo_svg_surface_set_document_unit(surface, CAIRO_SVG_UNIT_PT);
    return surface;
  }
  cairo_surface_t* surface =
      cairo_pdf_surface_create_for_stream(Append, bytes, width_pt, height_pt);
  // By default the present, which would make each file another.
  cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_CREATE_DATE, "");
  return surface;
}

void RequireSuccess(cairo_status_t status) {
  if (status == CAIRO_STATUS_SUCCESS) return;
  throw std::runtime_error(std::string("cannot draw the board: ") + cairo_status_to_string(status));
}

}  // namespace

Canvas::Canvas(PageFormat format) : format_(format) {}

void Canvas::BeginPage(double width_mm, double height_mm) {
  if (!cairo_) {
    surface_.reset(MakeSurface(format_, width_mm, height_mm, &bytes_));
    cairo_.reset(cairo_create(surface_.get()));
    cairo_scale(cairo_.get(), kPointsPerMm, kPointsPerMm);
    return;
  }
  if (format_ == PageFormat::kSvg) throw std::logic_error("an SVG has one page");
  cairo_show_page(cairo_.get());
  cairo_pdf_surface_set_size(surface_.get(), width_mm * kPointsPerMm, height_mm * kPointsPerMm);
}

void Canvas::FillRectangles(const std::vector<RectangleMm>& rectangles, const RectangleMm& clip) {
  cairo_save(cairo_.get());
  cairo_rectangle(cairo_.get(), clip.left, clip.top, clip.width, clip.height);
  cairo_clip(cairo_.get());
  for (const RectangleMm& one : rectangles) {
    cairo_rectangle(cairo_.get(), one.left, one.top, one.width, one.height);
  }
  cairo_fill(cairo_.get());
  cairo_restore(cairo_.get());
}

void Canvas::Line(
    double from_x_mm, double from_y_mm, double to_x_mm, double to_y_mm, double width_mm) {
  cairo_set_line_width(cairo_.get(), width_mm);
  cairo_move_to(cairo_.get(), from_x_mm, from_y_mm);
  cairo_line_to(cairo_.get(), to_x_mm, to_y_mm);
  cairo_stroke(cairo_.get());
}

void Canvas::Outline(const RectangleMm& rectangle, double width_mm) {
  cairo_set_line_width(cairo_.get(), width_mm);
  cairo_rectangle(cairo_.get(), rectangle.left, rectangle.top, rectangle.width, rectangle.height);
  cairo_stroke(cairo_.get());
}

void Canvas::Text(double x_mm, double y_mm, double size_mm, const std::string& text) {
  cairo_move_to(cairo_.get(), x_mm, y_mm);
  ShowText("sans-serif", size_mm, text);
}

void Canvas::FixedWidthText(double x_mm, double y_mm, double size_mm, const std::string& text) {
  cairo_move_to(cairo_.get(), x_mm, y_mm);
  ShowText("monospace", size_mm, text);
}

void Canvas::CentredText(double x_mm, double y_mm, double size_mm, const std::string& text) {
  cairo_select_font_face(
      cairo_.get(), "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(cairo_.get(), size_mm);
  cairo_text_extents_t extents{};
  cairo_text_extents(cairo_.get(), text.c_str(), &extents);
  Text(x_mm - extents.x_advance / 2, y_mm, size_mm, text);
}

void Canvas::DrawAt(double x_mm, double y_mm, double scale, const std::function<void()>& draw) {
  cairo_save(cairo_.get());
  cairo_translate(cairo_.get(), x_mm, y_mm);
  cairo_scale(cairo_.get(), scale, scale);
  draw();
  cairo_restore(cairo_.get());
}

std::string Canvas::Finish() {
  cairo_show_page(cairo_.get());
  RequireSuccess(cairo_status(cairo_.get()));
  cairo_surface_finish(surface_.get());
  RequireSuccess(cairo_surface_status(surface_.get()));
  return std::move(bytes_);
}

void Canvas::ShowText(const char* family, double size_mm, const std::string& text) {
  cairo_select_font_face(cairo_.get(), family, CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(cairo_.get(), size_mm);
  cairo_show_text(cairo_.get(), text.c_str());
}

}  // namespace voqcal
