#include "core/camera/named_lens.hpp"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <map>

namespace voqcal {
namespace {

// What others call our lenses, in small letters. Kalibr's "pinhole" says nothing of the distortion:
// its coefficients are then those of radtan, or none.
const std::map<std::string, LensModel> kNames = {
    {"plumb_bob", LensModel::kPlumbBob},
    {"radtan", LensModel::kPlumbBob},
    {"radial_tangential", LensModel::kPlumbBob},
    {"radial-tangential", LensModel::kPlumbBob},
    {"brown_conrady", LensModel::kPlumbBob},
    {"pinhole", LensModel::kPlumbBob},
    {"pinhole-radtan", LensModel::kPlumbBob},
    {"none", LensModel::kPlumbBob},
    {"non-fisheye", LensModel::kPlumbBob},  // cam_lidar_calibration's word
    {"rational", LensModel::kRational},
    {"rational_polynomial", LensModel::kRational},
    {"equidistant", LensModel::kEquidistant},
    {"equi", LensModel::kEquidistant},
    {"pinhole-equi", LensModel::kEquidistant},
    {"fisheye", LensModel::kEquidistant},
    {"kannala_brandt", LensModel::kEquidistant},
    {"kannala_brandt4", LensModel::kEquidistant},
};

constexpr std::size_t kNumOfOpenCv = 14;  // k1 k2 p1 p2 k3 k4 k5 k6 s1 s2 s3 s4 tau_x tau_y

std::string InSmallLetters(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char letter) {
    return static_cast<char>(std::tolower(letter));
  });
  return text;
}

/// Without the zeros at the end.
std::size_t NumUsed(const std::vector<double>& distortion) {
  const auto last = std::find_if(
      distortion.rbegin(), distortion.rend(), [](double value) { return value != 0.0; });
  return static_cast<std::size_t>(distortion.rend() - last);
}

LensRefusal UnknownModel() {
  return {false,
          "must be equidistant, plumb_bob or rational (another lens: calibrate it as one of these, "
          "with Kalibr by --models pinhole-radtan or pinhole-equi, or rectify the images)"};
}

LensRefusal WrongCount(const std::string& model, LensModel lens) {
  const std::string rule =
      "must be a list of " + std::to_string(NumDistortion(lens)) + " coefficients for lens_model ";
  return {true, rule + model};
}

LensRefusal PrismOrTilt() {
  return {true,
          "must have zeros after k6 (a thin prism or a tilted sensor is not known: calibrate the "
          "camera without CALIB_THIN_PRISM_MODEL and CALIB_TILTED_MODEL, or rectify the images)"};
}

/// How many coefficients such a lens may be given with; OpenCV's others follow ours.
bool IsCountKnown(const std::string& model, LensModel lens, const std::vector<double>& distortion) {
  const std::size_t num = distortion.size();
  if (lens == LensModel::kEquidistant) return num >= 4 && NumUsed(distortion) <= 4;
  if (num == 0) return model == "pinhole" || model == "none";
  const bool is_of_opencv = num == 8 || num == 12 || num == kNumOfOpenCv;
  return is_of_opencv || (lens == LensModel::kPlumbBob && (num == 4 || num == 5));
}

}  // namespace

Expected<LensModel, LensRefusal> LensModelByName(const std::string& model) {
  const auto known = kNames.find(InSmallLetters(model));
  if (known == kNames.end()) return UnknownModel();
  return known->second;
}

Expected<NamedLens, LensRefusal> LensByName(const std::string& model,
                                            const std::vector<double>& distortion) {
  const auto known = LensModelByName(model);
  if (!known) return known.error();
  NamedLens named{*known, {}};
  if (!IsCountKnown(InSmallLetters(model), named.lens, distortion))
    return WrongCount(model, named.lens);
  const std::size_t num_used = NumUsed(distortion);
  if (num_used > named.distortion.size()) return PrismOrTilt();
  // Five coefficients and more of them are the rational lens, however it is called.
  if (named.lens == LensModel::kPlumbBob && num_used > 5) named.lens = LensModel::kRational;
  std::copy_n(distortion.begin(), num_used, named.distortion.begin());
  return named;
}

}  // namespace voqcal
