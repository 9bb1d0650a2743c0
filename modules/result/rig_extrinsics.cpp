#include "result/rig_extrinsics.hpp"

#include <algorithm>
#include <cmath>

#include "core/format.hpp"
#include "core/units.hpp"
#include "files/atomic_file.hpp"
#include "files/number_text.hpp"
#include "files/transform_yaml.hpp"
#include "files/yaml_reader.hpp"
#include "result/assessment_yaml.hpp"
#include "result/verdict_yaml.hpp"

namespace voqcal {
namespace {

/// What JoinPairs was given.
std::vector<const CalibratedPair*> UsedPairs(const RigExtrinsics& result) {
  std::vector<const CalibratedPair*> used;
  for (const CalibratedPair& pair : result.pairs) {
    if (pair.problem.empty()) used.push_back(&pair);
  }
  return used;
}

bool IsOf(const CalibratedPair& pair, const std::string& from, const std::string& to) {
  const SensorPair& extrinsic = pair.extrinsic;
  return (extrinsic.from == from && extrinsic.to == to) ||
         (extrinsic.from == to && extrinsic.to == from);
}

const PairClosure* ClosureOf(const RigExtrinsics& result, const CalibratedPair& pair) {
  const std::vector<const CalibratedPair*> used = UsedPairs(result);
  for (const PairClosure& closure : result.network.closures) {
    if (used.at(closure.pair) == &pair) return &closure;
  }
  return nullptr;
}

bool IsLeftOut(const RigExtrinsics& result, const CalibratedPair& pair) {
  if (!pair.problem.empty()) return true;
  const std::vector<std::size_t>& doubtful = result.network.doubtful;
  return result.network.is_left_out && doubtful.size() == 1 &&
         UsedPairs(result).at(doubtful[0]) == &pair;
}

double DegreesOf(const Vector6d& difference) { return kDegPerRad * difference.head<3>().norm(); }
double MillimetresOf(const Vector6d& difference) { return 1e3 * difference.tail<3>().norm(); }

/// "bad: The whole scene".
std::string WorstOf(const Verdict& verdict) {
  std::string names;
  for (const VerdictCheck& check : verdict.checks) {
    if (check.grade == verdict.grade) names += (names.empty() ? ": " : ", ") + check.name;
  }
  return ToString(verdict.grade) + names;
}

/// Pairs that are bad by themselves, and that no other tests: what hangs on one is as bad as it.
std::string BadPairs(const RigExtrinsics& result) {
  std::string names;
  for (const CalibratedPair& pair : result.pairs) {
    const bool is_bad = pair.HasSession() && pair.verdict.grade == Grade::kBad;
    if (!is_bad || IsLeftOut(result, pair) || ClosureOf(result, pair) != nullptr) continue;
    names += (names.empty() ? "" : ", ") + pair.Name();
  }
  return names;
}

VerdictCheck CheckPairs(const RigExtrinsics& result) {
  VerdictCheck check = {"Pairs", BadPairs(result).empty() ? Grade::kGood : Grade::kBad, ""};
  std::string wanting;
  int num_used = 0;
  for (const CalibratedPair& pair : result.pairs) {
    if (IsLeftOut(result, pair)) continue;
    ++num_used;
    if (!pair.HasSession() || pair.verdict.grade == Grade::kGood) continue;
    wanting += (wanting.empty() ? "" : "; ") + pair.Name() + " (" + WorstOf(pair.verdict) + ")";
    check.grade = std::max(check.grade, Grade::kLook);
  }
  check.text = std::to_string(num_used) + " of " + std::to_string(result.pairs.size()) +
               " pairs join the rig.";
  if (!wanting.empty()) {
    check.text += " Not good by themselves: " + wanting +
                  ". The report in each one's folder says "
                  "why.";
  }
  return check;
}

VerdictCheck CheckLeftOut(const RigExtrinsics& result) {
  VerdictCheck check = {"Pairs left out", Grade::kGood, ""};
  for (const CalibratedPair& pair : result.pairs) {
    if (pair.problem.empty()) continue;
    check.text += (check.text.empty() ? "" : "; ") + pair.Name() + ": " + pair.problem;
  }
  check.text = check.text.empty() ? "None." : check.text + ". They stand by what others say.";
  return check;
}

VerdictCheck CheckClosure(const RigExtrinsics& result) {
  const SensorNetwork& network = result.network;
  if (!network.warning.empty()) return {"Closure", Grade::kLook, network.warning + "."};
  if (network.closures.empty()) {
    return {"Closure",
            Grade::kLook,
            "No pair can be tested by others: that takes a sensor that sees the board with both."};
  }
  Vector6d largest = Vector6d::Zero();
  for (const PairClosure& closure : network.closures) {
    if (MillimetresOf(closure.difference) > MillimetresOf(largest)) largest = closure.difference;
  }
  return {"Closure",
          Grade::kGood,
          Format("Every pair agrees with what the others say of it, within its uncertainty: by "
                 "%.2f deg, %.1f mm at most.",
                 DegreesOf(largest),
                 MillimetresOf(largest))};
}

std::string KindOf(const RigExtrinsics& result, const std::string& sensor) {
  const auto& lidars = result.lidars;
  return std::find(lidars.begin(), lidars.end(), sensor) != lidars.end() ? "lidar" : "camera";
}

std::string SensorsYaml(const RigExtrinsics& result) {
  const SensorNetwork& network = result.network;
  std::string text = "sensors:  # p_reference = T_reference_sensor * p_sensor, metres\n";
  for (std::size_t i = 0; i < network.sensors.size(); ++i) {
    const std::string& name = network.sensors[i];
    text += "  " + name + ":\n    kind: " + KindOf(result, name) + "\n    T_reference_sensor:\n" +
            TransformYaml(network.T_reference_sensor[i], "      ");
  }
  return text;
}

std::string JointCovarianceYaml(const SensorNetwork& network) {
  std::string names;
  for (const std::string& name : network.sensors) names += (names.empty() ? "" : ", ") + name;
  return "# joint, of every T_reference_sensor in this order: six rows a sensor, rotation_rad, "
         "then\n"
         "# translation_m, perturbed on the left (reference) side; those of the reference are 0\n"
         "covariance_of: [" +
         names + "]\ncovariance:  # if the rig file's cameras and board are exactly right\n" +
         RowsYaml(network.covariance, "  ");
}

/// What is said of the pair by itself.
std::string OwnYaml(const RigExtrinsics& result, const CalibratedPair& pair) {
  if (!pair.problem.empty()) {
    return "    calibrated: {folder: " + QuotedYaml(pair.folder) +
           ", problem: " + QuotedYaml(pair.problem) + "}\n";
  }
  std::string text =
      "    calibrated: {is_used: " + std::string(IsLeftOut(result, pair) ? "false" : "true") +
      ", num_samples: " + std::to_string(pair.num_samples);
  if (pair.HasSession()) {
    const std::string indent = ",\n                 ";
    text += indent + "folder: " + QuotedYaml(pair.folder) +
            ", grade: " + ToString(pair.verdict.grade) + indent +
            "headline: " + QuotedYaml(pair.verdict.headline) + indent +
            "samples_sha256: " + QuotedYaml(pair.samples_sha256);
  }
  text += "}\n";
  const PairClosure* closure = ClosureOf(result, pair);
  if (closure == nullptr) return text;
  return text + "    closure: {rotation_deg: " + NumberText(DegreesOf(closure->difference)) +
         ", translation_mm: " + NumberText(MillimetresOf(closure->difference)) +
         ", chi_square: " + NumberText(closure->chi_square) +
         ", contradicts: " + (closure->Contradicts() ? "true" : "false") + "}\n";
}

std::string PairsYaml(const RigExtrinsics& result) {
  std::string text =
      "# Every two sensors, by all that joins them: p_to = T_to_from * p_from, metres; covariance "
      "of\n"
      "# rotation_rad, then translation_m, perturbed on the left (side `to`). calibrated: what the "
      "pair\n"
      "# says by itself; closure: that against what all other pairs say (chi_square: 6 degrees of\n"
      "# freedom).\n"
      "pairs:\n";
  std::vector<std::string> sensors = result.lidars;
  sensors.insert(sensors.end(), result.cameras.begin(), result.cameras.end());
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    for (std::size_t j = i + 1; j < sensors.size(); ++j) {
      const SensorPair joined = result.network.Between(sensors[i], sensors[j]);
      text += "  - from: " + joined.from + "\n    to: " + joined.to + "\n    T_to_from:\n" +
              TransformYaml(joined.T_to_from, "      ") + "    covariance:\n" +
              RowsYaml(joined.covariance, "      ");
      for (const CalibratedPair& pair : result.pairs) {
        if (IsOf(pair, joined.from, joined.to)) text += OwnYaml(result, pair);
      }
    }
  }
  return text;
}

std::string SigmaText(const Matrix6d& covariance) {
  const Vector6d sigma = covariance.diagonal().cwiseSqrt();
  return Format("1 sigma %.3f deg, %.1f mm",
                kDegPerRad * sigma.head<3>().norm(),
                1e3 * sigma.tail<3>().norm());
}

std::string SensorLines(const SensorNetwork& network) {
  std::string text =
      "sensors (p_" + network.reference + " = T_" + network.reference + "_NAME * p_NAME)\n";
  for (std::size_t i = 0; i < network.sensors.size(); ++i) {
    if (network.sensors[i] == network.reference) continue;
    const Eigen::Isometry3d& T = network.T_reference_sensor[i];
    Eigen::Quaterniond q(T.linear());
    if (q.w() < 0) q.coeffs() = -q.coeffs();
    const auto row = static_cast<Eigen::Index>(6 * i);
    text +=
        Format("  %-12s translation_m %9.5f %9.5f %9.5f  quaternion_xyzw %9.6f %9.6f %9.6f %9.6f  ",
               network.sensors[i].c_str(),
               T.translation().x(),
               T.translation().y(),
               T.translation().z(),
               q.x(),
               q.y(),
               q.z(),
               q.w()) +
        SigmaText(network.covariance.block<6, 6>(row, row)) + "\n";
  }
  return text;
}

std::string PairLines(const RigExtrinsics& result) {
  std::string text = "pairs (own verdict; against what the others say of it)\n";
  for (const CalibratedPair& pair : result.pairs) {
    text += Format("  %-20s ", pair.Name().c_str());
    if (!pair.problem.empty()) {
      text += "left out: " + pair.problem + "\n";
      continue;
    }
    text += Format("%-4s %3d samples, ",
                   pair.HasSession() ? ToString(pair.verdict.grade).c_str() : "-",
                   pair.num_samples) +
            SigmaText(pair.extrinsic.covariance);
    if (const PairClosure* closure = ClosureOf(result, pair)) {
      text += Format("; closure %.3f deg, %.1f mm%s",
                     DegreesOf(closure->difference),
                     MillimetresOf(closure->difference),
                     closure->Contradicts() ? ": contradicts" : "");
    }
    text += IsLeftOut(result, pair) ? " (left out)\n" : "\n";
  }
  return text;
}

}  // namespace

Verdict VerdictOf(const RigExtrinsics& result) {
  Verdict verdict;
  verdict.checks = {CheckPairs(result), CheckLeftOut(result)};
  if (result.pairs.size() > 1) verdict.checks.push_back(CheckClosure(result));
  verdict.grade = Grade::kGood;
  for (const VerdictCheck& check : verdict.checks) {
    verdict.grade = std::max(verdict.grade, check.grade);
  }
  verdict.headline = verdict.grade == Grade::kGood   ? "Good."
                     : verdict.grade == Grade::kLook ? "Usable; what is marked below would make it "
                                                       "better."
                                                     : "Do not use it: " + BadPairs(result) +
                                                           ", bad by itself and tested by no "
                                                           "other, is part of it; the others hold "
                                                           "as told below.";
  return verdict;
}

std::string ToYaml(const RigExtrinsics& result) {
  return "# Where every sensor of a rig is, by voqcal: its pairs' calibrations as one tree.\n"
         "rig: " +
         QuotedYaml(result.rig) + "\nreference: " + result.network.reference +
         "  # the sensor whose frame the tree hangs from\n" + VerdictYaml(VerdictOf(result)) +
         SensorsYaml(result) + JointCovarianceYaml(result.network) + PairsYaml(result) +
         "made_from:  # and of each pair's samples.lcm, above\n  rig_sha256: " +
         QuotedYaml(result.rig_sha256) + "\n  version: " + QuotedYaml(result.version) + "\n";
}

std::string Summary(const RigExtrinsics& result) {
  const Verdict verdict = VerdictOf(result);
  std::string text = "verdict  " + verdict.headline + "\n";
  for (const VerdictCheck& check : verdict.checks) {
    if (check.grade != Grade::kGood) text += "  " + check.name + ": " + check.text + "\n";
  }
  return text + SensorLines(result.network) + PairLines(result);
}

std::optional<std::filesystem::path> RigResultFileAt(const std::filesystem::path& path) {
  std::error_code ignored;  // told by whoever reads it
  const bool is_folder = std::filesystem::is_directory(path, ignored);
  const std::filesystem::path file = is_folder ? path / kRigResultName : path;
  if (!std::filesystem::exists(file, ignored)) return std::nullopt;
  YamlDocument document(file.string(), ReadWholeFile(file));
  YamlSection top(&document);
  if (!top.Has("reference") || !top.Has("sensors")) return std::nullopt;
  return file;
}

SensorTree ReadSensorTree(const std::filesystem::path& file) {
  YamlDocument document(file.string(), ReadWholeFile(file));
  YamlSection top(&document);
  SensorTree tree;
  top.Read("rig", &tree.rig);
  top.ReadRequired("reference", &tree.reference);
  std::string grade;
  top.Section("verdict").Read("grade", &grade);
  tree.is_to_be_mended = grade == ToString(Grade::kBad);
  YamlSection sensors = top.RequiredSection("sensors");
  for (const std::string& name : sensors.keys()) {
    YamlSection section = sensors.Section(name);
    SensorTree::Sensor sensor;
    sensor.name = name;
    std::string kind;
    section.ReadRequired("kind", &kind);
    sensor.is_lidar = kind == "lidar";
    YamlSection transform = section.RequiredSection("T_reference_sensor");
    ReadTransform(&transform, &sensor.T_reference_sensor);
    const bool is_reference = name == tree.reference;
    tree.sensors.insert(is_reference ? tree.sensors.begin() : tree.sensors.end(), sensor);
  }
  if (!sensors.Has(tree.reference)) top.AddError("reference", "must be one of the sensors");
  document.ThrowIfWrong();
  return tree;
}

}  // namespace voqcal
