#include "rig_calibrator/rig_calibrator_node.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <utility>

#include <spdlog/spdlog.h>

#include "core/guidance/weakest_pair.hpp"
#include "core/sensor_network/sensor_pair.hpp"
#include "files/atomic_file.hpp"
#include "messaging/convert_board.hpp"
#include "messaging/convert_rig.hpp"
#include "messaging/encode.hpp"
#include "messaging/made_from.hpp"
#include "voqcal/assessment_t.hpp"
#include "voqcal/extrinsic_averaged_t.hpp"
#include "voqcal/extrinsic_refined_t.hpp"
#include "voqcal/voq_sets_t.hpp"

namespace voqcal {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kLookAtWorker{50};

/// Of a pair that waits for its turn.
PairSession WaitingSession(const Rig& rig) {
  PairSession session = SessionOf(rig);
  TakeResult({}, std::nullopt, "", &session);
  session.pair.problem = "not calibrated yet";
  return session;
}

template <typename Message>
void KeepSaid(const std::string& channel,
              Bus* bus,
              std::map<std::string, std::vector<std::uint8_t>>* said) {
  bus->Subscribe<Message>(channel, Queue::kState, [channel, said](const Message& message) {
    (*said)[channel] = EncodeMessage(message);
  });
}

/// To the weakest of all pairs.
std::string AdviceOn(const std::string& pair, const std::optional<next_pose_t>& next) {
  if (!next) return "Show the board to " + pair + ".";
  if (next->is_enough != 0) return pair + ": " + next->advice;
  if (!next->problem.empty()) return pair + ": " + next->problem;
  return "Show the board to " + pair + ": " + next->advice;
}

/// A tree that is not of these samples must not be taken for theirs.
void WriteResult(const std::filesystem::path& file, const RigExtrinsics& rig) {
  if (rig.network.IsUsable()) return WriteFileAtomically(file, ToYaml(rig));
  std::filesystem::remove(file);
}

}  // namespace

RigCalibratorNode::Chain::Chain(const Rig& rig_in, const std::filesystem::path& folder)
    : rig(rig_in), bus("memq://"), modules(rig, &bus, folder), guide(rig, &bus) {
  KeepSaid<voq_sets_t>(rig.channels.voq_sets, &bus, &said);
  KeepSaid<extrinsic_averaged_t>(rig.channels.extrinsic_averaged, &bus, &said);
  KeepSaid<extrinsic_refined_t>(rig.channels.extrinsic_refined, &bus, &said);
  KeepSaid<assessment_t>(rig.channels.calib_assessment, &bus, &said);
  KeepSaid<next_pose_t>(rig.channels.next_pose, &bus, &said);
  bus.Keep(rig.channels.next_pose, &next_pose);
}

PairSession RigCalibratorNode::Chain::Calibrate(const samples_t& message,
                                                const std::vector<BoardSample>& samples) {
  bus.Publish(rig.channels.calib_samples, message);
  modules.Run();
  guide.Step();
  bus.HandleWaiting();
  PairSession session = SessionOf(rig);
  if (modules.assessor().HasAssessed(message)) {
    TakeResult(samples, modules.assessor().result(), modules.assessor().problem(), &session);
  } else {
    TakeResult({}, std::nullopt, "", &session);
    session.pair.problem = "its samples could not be calibrated: an error of the program";
  }
  return session;
}

RigCalibratorNode::RigCalibratorNode(const std::vector<Rig>& pairs,
                                     Bus* bus,
                                     const std::filesystem::path& session_folder)
    : bus_(*bus),
      channel_(pairs.front().channels.rig_extrinsics),
      result_file_(session_folder / kRigResultName),
      made_from_{pairs.front().rig_name, pairs.front().sha256, VOQCAL_VERSION},
      pairs_(pairs.size()),
      working_on_(pairs.size() - 1) {
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const Rig& rig = pairs[i];
    pairs_[i].name = PairName(rig.lidar_name, rig.camera_name);
    pairs_[i].chain = std::make_unique<Chain>(rig, session_folder / pairs_[i].name);
    bus_.Keep(rig.channels.calib_samples, &pairs_[i].newest);
    sessions_.push_back(WaitingSession(rig));
  }
  message_ = ToMessage(JoinSessions(sessions_, "", made_from_));
}

void RigCalibratorNode::WaitForThreads() {
  if (work_.valid()) Take(work_.get());
}

RigCalibratorNode::~RigCalibratorNode() {
  if (!work_.valid()) return;
  try {
    work_.get();
  } catch (const std::exception& error) {
    spdlog::error("{}: {}", pairs_[working_on_].name, error.what());
  }
}

std::string RigCalibratorNode::State() const {
  const auto num_heard = std::count_if(
      pairs_.begin(), pairs_.end(), [](const Pair& pair) { return pair.newest.has_value(); });
  if (num_heard == 0) return "waiting for samples";
  const auto num_done = std::count_if(sessions_.begin(), sessions_.end(), [](const auto& session) {
    return session.pair.problem.empty();
  });
  std::string state = "running: " + std::to_string(num_done) + " of " +
                      std::to_string(pairs_.size()) + " pairs have an extrinsic";
  if (work_.valid()) state += ", at work on " + pairs_[working_on_].name;
  return state;
}

std::optional<Clock::time_point> RigCalibratorNode::NextStep() const {
  if (!work_.valid()) return {};
  return Clock::now() + kLookAtWorker;
}

bool RigCalibratorNode::Step() {
  if (work_.valid()) {
    if (work_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return false;
    Take(work_.get());
  }
  if (const auto next = NextToDo()) Start(*next);
  return false;
}

void RigCalibratorNode::Republish() {
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    if (pairs_[i].IsWaiting() && pairs_[i].newest) {
      message_.pairs[i].num_samples = pairs_[i].newest->num_samples;
    }
  }
  AdviseOnWeakest();
  CountRevision();
  bus_.Publish(channel_, message_);
  for (const Pair& pair : pairs_) {
    for (const auto& [channel, bytes] : pair.said) {
      bus_.PublishBytes(channel, bytes.data(), bytes.size());
    }
  }
}

void RigCalibratorNode::CountRevision() {
  rig_extrinsics_t content = message_;
  content.revision = 0;
  std::vector<std::uint8_t> bytes = EncodeMessage(content);
  if (bytes != content_) ++revision_;
  content_ = std::move(bytes);
  message_.revision = revision_;
}

void RigCalibratorNode::AdviseOnWeakest() {
  std::vector<PairNeed> needs;
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    const auto& next = pairs_[i].next_pose;
    needs.push_back(NeedOf(message_.pairs[i], next ? &*next : nullptr));
  }
  weakest_ = WeakestPair(needs, weakest_);
  message_.weakest_pair = weakest_ ? pairs_[*weakest_].name : "";
  message_.advice = weakest_ ? AdviceOn(pairs_[*weakest_].name, pairs_[*weakest_].next_pose) : "";
}

bool RigCalibratorNode::IsToDo(const Pair& pair) const {
  return pair.newest && !(pair.made_of.revision == pair.newest->revision &&
                          pair.made_of.sha256 == pair.newest->log_sha256);
}

// Each in its turn: one that changes all the time keeps none waiting.
std::optional<std::size_t> RigCalibratorNode::NextToDo() const {
  for (std::size_t i = 1; i <= pairs_.size(); ++i) {
    const std::size_t pair = (working_on_ + i) % pairs_.size();
    if (IsToDo(pairs_[pair])) return pair;
  }
  return std::nullopt;
}

void RigCalibratorNode::Start(std::size_t index) {
  Pair& pair = pairs_[index];
  std::vector<BoardSample> samples;
  if (!CanRead([&] { samples = FromMessage(*pair.newest); })) {
    pair.newest.reset();
    return;
  }
  working_on_ = index;
  pair.made_of = {pair.newest->utime, pair.newest->revision, pair.newest->log_sha256};
  // Before that a tree without the others would take the place of an earlier one with them.
  const bool is_whole =
      std::none_of(pairs_.begin(), pairs_.end(), [](const Pair& each) { return each.IsWaiting(); });
  work_ = std::async(
      std::launch::async,
      [this,
       index,
       is_whole,
       chain = pair.chain.get(),
       message = *pair.newest,
       samples = std::move(samples),
       sessions = sessions_]() mutable {
        sessions[index] = chain->Calibrate(message, samples);
        Outcome outcome = {
            sessions[index], chain->said, chain->next_pose, JoinSessions(sessions, "", made_from_)};
        if (is_whole) WriteResult(result_file_, outcome.rig);
        return outcome;
      });
}

void RigCalibratorNode::Take(const Outcome& outcome) {
  sessions_[working_on_] = outcome.session;
  pairs_[working_on_].said = outcome.said;
  pairs_[working_on_].next_pose = outcome.next_pose;
  Count(outcome.session.pair.problem.empty() ? "calibrations" : "without a result");
  message_ = ToMessage(outcome.rig);
  for (std::size_t i = 0; i < pairs_.size(); ++i) {  // which come before those of two cameras
    const MadeOf& made_of = pairs_[i].made_of;
    message_.utime = std::max(message_.utime, made_of.utime);
    message_.pairs[i].samples_revision = made_of.revision;
    message_.pairs[i].samples_sha256 = made_of.sha256;
  }
  Republish();
}

}  // namespace voqcal
