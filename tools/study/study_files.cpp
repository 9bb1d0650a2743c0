#include "study/study_files.hpp"

#include <cmath>
#include <string>

#include "files/atomic_file.hpp"
#include "files/number_text.hpp"

namespace voqcal {
namespace {

// One line of a table. Numbers read back exactly; one that is not finite is an empty field.
class Row {
 public:
  Row& Add(const std::string& text) {
    line_ += (is_first_ ? "" : ",") + text;
    is_first_ = false;
    return *this;
  }
  Row& Add(double value) { return Add(std::isfinite(value) ? NumberText(value) : ""); }
  Row& Add(std::int64_t value) { return Add(std::to_string(value)); }
  Row& Add(const Spread& spread) { return Add(spread.mean).Add(spread.std).Add(spread.max); }
  std::string Line() const { return line_ + "\n"; }

 private:
  std::string line_;
  bool is_first_ = true;
};

std::string SetsCsv(const Study& study) {
  std::string text =
      "sample_a,sample_b,sample_c,kappa,e_be_mm,voq,volume,predicted_error_mm,centre_distance_m,"
      "status,mean_px,mean_mm,deviation_mm,held_out_mm\n";
  for (const StudiedSet& set : study.sets) {
    Row row;
    for (const int i : set.samples) row.Add(study.sample_ids[static_cast<std::size_t>(i)]);
    row.Add(set.kappa).Add(set.board_error_mm).Add(set.voq).Add(set.volume);
    row.Add(set.predicted_error_mm).Add(set.centre_distance_m);
    row.Add(ToString(set.extrinsic.status));
    row.Add(set.mean_px).Add(set.mean_mm).Add(set.deviation_mm).Add(set.held_out_mm);
    text += row.Line();
  }
  return text;
}

std::string BinsCsv(const Study& study) {
  std::string text =
      "experiment,num_sets,figure,rotation_spread_deg,translation_spread_mm,error_mm,"
      "median_error_mm,deviation_mm\n";
  for (const Experiment& experiment : study.experiments) {
    for (const StudyBin& bin : experiment.bins) {
      Row row;
      row.Add(experiment.name).Add(std::int64_t{bin.num_sets}).Add(bin.figure);
      row.Add(bin.rotation_spread_deg).Add(bin.translation_spread_mm);
      row.Add(bin.error_mm).Add(bin.median_error_mm).Add(bin.deviation_mm);
      text += row.Line();
    }
  }
  return text;
}

std::string CorrelationsCsv(const Study& study) {
  std::string text = "figure,spearman\n";
  for (const RankCorrelation& each : study.correlations) {
    text += Row().Add(each.figure).Add(each.spearman).Line();
  }
  return text;
}

std::string SelectorsCsv(const Study& study) {
  std::string text =
      "criterion,average_mean_mm,average_deviation_mm,average_max_mm,final_mean_mm,"
      "final_deviation_mm,final_max_mm\n";
  for (const SelectorScore& each : study.selectors) {
    text += Row().Add(each.name).Add(each.average_mm).Add(each.final_mm).Line();
  }
  return text;
}

}  // namespace

void WriteStudy(const Study& study, const std::filesystem::path& folder) {
  WriteFileAtomically(folder / "sets.csv", SetsCsv(study));
  WriteFileAtomically(folder / "bins.csv", BinsCsv(study));
  WriteFileAtomically(folder / "correlations.csv", CorrelationsCsv(study));
  WriteFileAtomically(folder / "selectors.csv", SelectorsCsv(study));
}

}  // namespace voqcal
