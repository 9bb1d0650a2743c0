#include "sample_collector/sample_collector_node.hpp"

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <utility>

#include <spdlog/spdlog.h>

#include "core/least_samples.hpp"
#include "core/sensor_network/sensor_pair.hpp"
#include "messaging/convert_board.hpp"
#include "messaging/encode.hpp"
#include "messaging/session_misses.hpp"
#include "voqcal/event_t.hpp"
#include "voqcal/image_t.hpp"
#include "voqcal/module_status_t.hpp"
#include "voqcal/pointcloud2_t.hpp"
#include "voqcal/samples_t.hpp"

namespace voqcal {
namespace {

// Of each sensor, where its detector falls behind or is silent: some seconds of JPEG or of a
// 128-beam lidar, 36 raw images of 1920 x 1208.
constexpr std::size_t kMaxBufferBytes = 256U << 20U;

/// Samples and stops that the lidar was unsure of, together, before any tells where another is.
constexpr std::size_t kFirstLook = 5;

/// A reason in CALIB_EVENT.
constexpr char kByCommand[] = "by command";

/// Why a frame was judged without one of the other sensor, but for BetweenFrames.
bool IsOutOfOrder(const std::string& reason) {
  return reason == "lidar frame out of order" || reason == "camera frame out of order";
}

/// Sensors of two rates leave frames without a partner, which is no miss; empty for other reasons.
std::string BetweenFrames(const std::string& reason) {
  if (reason == "no camera frame at that time") return "sweeps between two images";
  if (reason == "no lidar frame at that time") return "images between two sweeps";
  return {};
}

}  // namespace

SampleCollectorNode::SampleCollectorNode(const Rig& rig,
                                         Bus* bus,
                                         const std::filesystem::path& session_folder)
    : channels_(rig.channels),
      pair_(PairName(rig.lidar_name, rig.camera_name)),
      bus_(*bus),
      session_folder_(session_folder),
      picker_(rig.board, rig.sample_collector),
      lidar_{FrameBuffer(kMaxBufferBytes)},
      camera_{FrameBuffer(kMaxBufferBytes)},
      second_look_(rig),
      next_look_(kFirstLook),
      session_(session_folder),
      log_sha256_(session_.Sha256()) {
  picker_.SetKnown(session_.samples());
  bus_.SubscribeWithBytes<pointcloud2_t>(
      channels_.lidar_points,
      Queue::kEvery,
      [this](const pointcloud2_t& m, const std::uint8_t* bytes, std::size_t num_bytes) {
        clocks_.TakeLidar(m.utime);
        Keep({m.utime, {bytes, bytes + num_bytes}}, &lidar_);
      });
  bus_.SubscribeWithBytes<image_t>(
      channels_.camera_image,
      Queue::kEvery,
      [this](const image_t& m, const std::uint8_t* bytes, std::size_t num_bytes) {
        clocks_.TakeCamera(m.utime);
        Keep({m.utime, {bytes, bytes + num_bytes}}, &camera_);
      });
  bus_.Subscribe<lidar_board_t>(
      channels_.lidar_board, Queue::kEvery, [this](const lidar_board_t& m) {
        OnBoard(m, &lidar_);
        lidar_.frames.ForgetJudged(m.utime, picker_.InUse().lidar_utimes);
      });
  bus_.Subscribe<camera_board_t>(
      channels_.camera_board, Queue::kEvery, [this](const camera_board_t& m) {
        OnBoard(m, &camera_);
        camera_.frames.ForgetJudged(m.utime, picker_.InUse().camera_utimes);
      });
  bus_.Subscribe<module_status_t>(
      channels_.module_status, Queue::kEvery, [this](const module_status_t& m) {
        heartbeats_.Take(m, std::chrono::steady_clock::now());
      });
  bus_.Subscribe<command_t>(channels_.calib_command,
                            Queue::kEvery,
                            [this](const command_t& message) { OnCommand(message); });
}

std::string SampleCollectorNode::State() const {
  const std::string trouble = clocks_.Trouble();
  if (!trouble.empty()) return "trouble: " + trouble;
  std::string state =
      (is_finished_ ? "finished: " : "running: ") + std::to_string(samples().size()) + " samples";
  if (!second_look_.empty()) {
    state += ", " + std::to_string(second_look_.size()) + " stops without a board";
  }
  return state;
}

// Called when no message waits.
bool SampleCollectorNode::Step() {
  was_idle_ = true;
  return false;
}

void SampleCollectorNode::Republish() {
  if (is_finish_requested_ && IsAllJudged()) Finish();
  for (Stream* stream : {&lidar_, &camera_}) {
    stream->has_new_frames = stream->has_new_boards = false;
  }
  was_idle_ = false;
  PublishSamples();
}

void SampleCollectorNode::Accept(const BoardSample& sample,
                                 const SampleScene& scene,
                                 const std::string& remark) {
  is_finished_ = false;
  const std::int64_t id = session_.Accept(sample, scene);
  log_sha256_ = session_.Sha256();
  Count("accepted");
  Announce(sample.utime, "accepted", id, remark);
  PublishSamples();
}

void SampleCollectorNode::AcceptWithScene(const BoardSample& sample) {
  const SampleScene scene = {lidar_.frames.Find(sample.utime),
                             camera_.frames.Find(sample.camera_utime)};
  if (!scene.IsWhole()) Count("accepted without its scene");
  std::string remark = is_capture_requested_ ? kByCommand : "";
  if (!scene.IsWhole()) {
    remark += remark.empty() ? "" : "; ";
    remark += "its sweep or image did not arrive: no scene";
  }
  is_capture_requested_ = false;
  Accept(sample, scene, remark);
}

void SampleCollectorNode::Finish() {
  Decide(picker_.Flush());
  SayFinished();
}

void SampleCollectorNode::RequestFinish() {
  if (is_finish_requested_) return;
  is_finish_requested_ = true;
  finish_utime_ = std::max(lidar_.frames.NewestUtime(), camera_.frames.NewestUtime());
}

bool SampleCollectorNode::IsNetworkShared() const {
  return !heartbeats_.Rivals(std::chrono::steady_clock::now()).empty();
}

bool SampleCollectorNode::IsTooLate(std::int64_t utime) const {
  return is_finished_ || (finish_utime_ && utime > *finish_utime_);
}

void SampleCollectorNode::GoOn() {
  is_finish_requested_ = false;
  is_finished_ = false;
  finish_utime_.reset();
}

bool SampleCollectorNode::IsAllJudged() const {
  const bool is_silent = !lidar_.has_new_boards && !camera_.has_new_boards && was_idle_;
  return is_silent || (IsJudged(lidar_) && IsJudged(camera_));
}

// A stall of this process can pass for a silent second: only an empty queue shows that it was one.
bool SampleCollectorNode::IsJudged(const Stream& stream) const {
  const bool is_silent = !stream.has_new_frames && !stream.has_new_boards && was_idle_;
  return is_silent || (finish_utime_ && stream.board_utime > *finish_utime_);
}

void SampleCollectorNode::LookAgain(bool is_resting) {
  constexpr int kMaxRounds =
      3;  // what is found makes the extrinsic, and so the place, more certain
  std::vector<std::string> misses;
  for (int round = 0; round < kMaxRounds && !second_look_.empty(); ++round) {
    misses.clear();
    const std::vector<KeptStop> found = second_look_.FindBoards(samples(), is_resting, &misses);
    for (const KeptStop& each : found) {
      const PickerDecision decision = picker_.TakeStop(each.stop);
      if (!decision.accepted) {  // "pose is not new": the lidar saw it by itself meanwhile
        Count("second look: " + decision.reason);
        continue;
      }
      Count("found at a second look");
      const SensorFrame* image = each.image ? &*each.image : nullptr;
      Accept(*decision.accepted, {&each.sweeps.front(), image}, "at a second look");
    }
    if (found.empty()) break;
  }
  if (is_resting) return;  // there will be another look
  for (const std::string& miss : misses) Count("second look: " + miss);
}

void SampleCollectorNode::LookAgainIfDue() {
  const std::size_t num = samples().size() + second_look_.size();
  if (num < next_look_) return;
  LookAgain(/*is_resting=*/true);
  next_look_ = num + num / 2;
}

void SampleCollectorNode::SayFinished() {
  CancelCapture();  // the operator wants no more
  LookAgain(/*is_resting=*/false);
  is_finish_requested_ = false;
  is_finished_ = true;
  SaveMisses();
  Announce(samples().empty() ? 0 : samples().back().utime, "finished", 0, "");
  PublishSamples();
}

void SampleCollectorNode::SaveMisses() const try {
  std::filesystem::remove(session_folder_ / kMissesLogName);  // of an earlier finish
  if (samples().size() < kLeastSamples) misses_.Save(session_folder_, *this);
} catch (const std::exception& error) {  // the samples are what matters
  spdlog::warn("what was seen is not kept: {}", error.what());
}

void SampleCollectorNode::NoteMiss(const lidar_board_t& message) {
  misses_.Note(kMissSweepChannel,
               kLidarMissChannel,
               message.miss,
               lidar_.frames.Find(message.utime),
               EncodeMessage(message));
}

void SampleCollectorNode::NoteMiss(const camera_board_t& message) {
  misses_.Note(kMissImageChannel,
               kCameraMissChannel,
               message.miss,
               camera_.frames.Find(message.utime),
               EncodeMessage(message));
}

void SampleCollectorNode::Keep(SensorFrame frame, Stream* stream) {
  stream->has_new_frames = true;
  stream->frames.Add(std::move(frame));
}

// A message that contradicts itself is a frame without a board, and costs that frame only.
template <typename BoardMessage>
void SampleCollectorNode::OnBoard(const BoardMessage& message, Stream* stream) {
  stream->has_new_boards = true;
  stream->board_utime = message.utime;
  if (IsTooLate(message.utime)) return;
  if (IsNetworkShared()) return Count("frames while two sessions ran on one network");
  if (!message.miss.empty()) NoteMiss(message);
  decltype(SightingFromMessage(message)) sighting;
  try {
    sighting = SightingFromMessage(message);
  } catch (const std::runtime_error& error) {
    spdlog::debug("unreadable board message: {}", error.what());
    sighting = {message.utime, {}, "unreadable board message"};
  }
  Decide(picker_.Add(sighting));
}

void SampleCollectorNode::OnCommand(const command_t& message) {
  if (!message.pair.empty() && message.pair != pair_) return;  // another one of the rig
  if (message.command == "capture") {
    GoOn();
    picker_.RequestCapture();
    is_capture_requested_ = true;
  } else if (message.command == "discard") {
    Discard(message);
  } else if (message.command == "finish") {
    RequestFinish();
  } else if (message.command == "reset") {
    Reset(message.utime);
  } else {
    Announce(message.utime, "rejected", 0, "unknown command '" + message.command + "'");
    Count("unknown command");
  }
}

void SampleCollectorNode::Reset(std::int64_t utime) {
  session_.Reset();
  log_sha256_ = session_.Sha256();
  picker_.StartAnew();
  CancelCapture();
  second_look_.Clear();
  misses_.Clear();
  next_look_ = kFirstLook;
  GoOn();
  Announce(utime, "reset", 0, "");
  PublishSamples();
}

void SampleCollectorNode::CancelCapture() {
  picker_.CancelCapture();
  is_capture_requested_ = false;
}

void SampleCollectorNode::Discard(const command_t& message) {
  const std::optional<std::int64_t> id = session_.Discard(message.sample_id);
  if (!id) {
    const std::string reason = samples().empty()
                                   ? "there is no sample to discard"
                                   : "there is no sample " + std::to_string(message.sample_id);
    Announce(message.utime, "rejected", message.sample_id, reason);
    return;
  }
  log_sha256_ = session_.Sha256();
  picker_.SetKnown(samples());
  Count("discarded");
  Announce(message.utime, "discarded", *id, kByCommand);
  PublishSamples();
}

void SampleCollectorNode::Decide(const std::vector<PickerDecision>& decisions) {
  for (const PickerDecision& decision : decisions) {
    const std::string between = BetweenFrames(decision.reason);
    if (between.empty() && !IsOutOfOrder(decision.reason)) clocks_.NotePair();
    if (decision.unsure && !second_look_.Keep(*decision.unsure, lidar_.frames, camera_.frames)) {
      Count("no room for a second look");
    }
    if (decision.accepted) {
      AcceptWithScene(*decision.accepted);
    } else if (!between.empty()) {
      Count(between);
    } else {
      Count(decision.reason);
      const std::string& detail = decision.detail;
      Announce(decision.utime,
               "rejected",
               0,
               detail.empty() ? decision.reason : decision.reason + ": " + detail);
    }
    LookAgainIfDue();
  }
}

void SampleCollectorNode::Announce(std::int64_t utime,
                                   const std::string& kind,
                                   std::int64_t sample_id,
                                   const std::string& reason) {
  event_t event{};
  event.utime = utime;
  event.seq = event_seq_++;
  event.kind = kind;
  event.sample_id = sample_id;
  event.reason = reason;
  bus_.Publish(channels_.calib_event, event);
}

void SampleCollectorNode::PublishSamples() {
  bus_.Publish(channels_.calib_samples,
               ToMessage(samples(), session_.revision(), is_finished_, log_sha256_));
}

}  // namespace voqcal
