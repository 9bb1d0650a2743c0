#pragma once

#include <cstdint>
#include <filesystem>
#include <future>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "messaging/bus.hpp"
#include "messaging/module.hpp"
#include "pose_guide/pose_guide_node.hpp"
#include "result/join_rig.hpp"
#include "rig/rig.hpp"
#include "rig_calibrator/pair_chain.hpp"
#include "voqcal/next_pose_t.hpp"
#include "voqcal/rig_extrinsics_t.hpp"
#include "voqcal/samples_t.hpp"

namespace voqcal {

/// CALIB_SAMPLES of every pair in, RIG_EXTRINSICS, what a pair's own modules would say (VOQ_SETS to
/// CALIB_ASSESSMENT, and NEXT_POSE) and the session's files out: calibrates a pair when its samples
/// have changed, and joins all to one tree. A worker does that, one pair after the other, each on
/// its newest samples: messages are heard meanwhile.
///
/// The files are those that calibrate_rig leaves, of the same samples to the byte: extrinsic.yaml
/// in the folder of each pair, rig_extrinsics.yaml beside them. A rig_extrinsics.yaml that is there
/// already stays until every pair was worked on.
class RigCalibratorNode : public Module {
 public:
  /// @param pairs  LoadPairs of a rig.
  /// @param bus    borrowed; must outlive the node.
  /// @param session_folder  has a folder front_left, ... of each pair, with its samples.lcm.
  RigCalibratorNode(const std::vector<Rig>& pairs,
                    Bus* bus,
                    const std::filesystem::path& session_folder);
  /// Waits for the worker, and logs what it threw.
  ~RigCalibratorNode() override;

  std::string Name() const override { return "rig_calibrator"; }
  std::string State() const override;
  bool Step() override;
  std::optional<std::chrono::steady_clock::time_point> NextStep() const override;
  void Republish() override;
  void WaitForThreads() override;

 private:
  /// Encoded messages by channel.
  using Messages = std::map<std::string, std::vector<std::uint8_t>>;

  /// A pair as the worker has it, which alone touches it while it works.
  struct Chain {
    Chain(const Rig& rig, const std::filesystem::path& folder);
    PairSession Calibrate(const samples_t& message, const std::vector<BoardSample>& samples);

    Rig rig;
    Bus bus;
    Messages said;  ///< By its modules, the newest.
    std::optional<next_pose_t> next_pose;
    PairChain modules;
    PoseGuideNode guide;
  };
  /// Which samples a session was made from.
  struct MadeOf {
    std::int64_t utime = 0;
    std::int64_t revision = -1;  ///< None yet.
    std::string sha256;
  };
  /// What is heard of it, and what came of that.
  struct Pair {
    std::string name;
    std::unique_ptr<Chain> chain;
    std::optional<samples_t> newest;
    MadeOf made_of;
    Messages said;
    std::optional<next_pose_t> next_pose;

    /// It was not worked on yet.
    bool IsWaiting() const { return made_of.revision < 0; }
  };
  struct Outcome {
    PairSession session;
    Messages said;
    std::optional<next_pose_t> next_pose;
    RigExtrinsics rig;
  };

  bool IsToDo(const Pair& pair) const;
  std::optional<std::size_t> NextToDo() const;
  void Start(std::size_t pair);
  void Take(const Outcome& outcome);
  /// Says in `message_` which pair is the weakest, and what helps it.
  void AdviseOnWeakest();
  /// Gives `message_` a new revision if it is not what was said last.
  void CountRevision();

  Bus& bus_;
  std::string channel_;
  std::filesystem::path result_file_;
  RigMadeFrom made_from_;
  std::vector<Pair> pairs_;
  std::vector<PairSession> sessions_;  ///< By pair.
  std::future<Outcome> work_;
  std::size_t working_on_ = 0;  ///< Or worked on last.
  std::optional<std::size_t> weakest_;
  rig_extrinsics_t message_{};
  std::vector<std::uint8_t> content_;  ///< Of what was said last, but for its revision...
  std::int64_t revision_ = 0;          ///< ...which is this.
};

}  // namespace voqcal
