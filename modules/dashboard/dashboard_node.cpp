#include "dashboard/dashboard_node.hpp"

#include <ctime>
#include <stdexcept>
#include <tuple>
#include <utility>

#include <spdlog/spdlog.h>

#include "core/sensor_network/sensor_pair.hpp"
#include "dashboard/exports.hpp"
#include "dashboard/sensor_frames.hpp"
#include "files/atomic_file.hpp"
#include "messaging/convert_board.hpp"
#include "messaging/convert_points.hpp"
#include "messaging/convert_result.hpp"
#include "messaging/made_from.hpp"
#include "messaging/wall_clock.hpp"
#include "result/result_file.hpp"
#include "voqcal/command_t.hpp"

namespace voqcal {
namespace {

constexpr std::size_t kMaxEvents = 40;
constexpr std::chrono::milliseconds kStepPeriod{50};  // a click must not seem to hang
constexpr std::chrono::milliseconds kLookPeriod{500};
// An image is shown with the board that was found in it, or without if that takes longer.
constexpr std::chrono::milliseconds kBoardPatience{500};
constexpr std::chrono::seconds kBoardsCome{2};
constexpr std::size_t kMaxBoards = 20;

/// With no page open a frame a second is kept ready for the next.
std::chrono::steady_clock::duration Period(double rate_hz, bool has_pages) {
  const std::chrono::duration<double> period(has_pages ? 1.0 / rate_hz : 1.0);
  return std::chrono::duration_cast<std::chrono::steady_clock::duration>(period);
}

/// What rejects have in common: "the board moves: 0.12 m" is the same as "the board moves: 0.13 m".
std::string Cause(const event_t& event) {
  return event.kind + " " + event.reason.substr(0, event.reason.find(':'));
}

std::vector<std::string> NamesOf(const std::map<std::string, StaticFile>& files) {
  std::vector<std::string> names;
  for (const auto& [name, file] : files) names.push_back(name);
  return names;
}

}  // namespace

DashboardNode::DashboardNode(const Rig& rig,
                             Bus* bus,
                             DashboardServer* server,
                             const std::filesystem::path& session_folder,
                             const std::vector<std::string>& report_command)
    : rig_(rig),
      bus_(*bus),
      server_(*server),
      session_folder_(session_folder),
      result_file_(session_folder / "extrinsic.yaml"),
      health_(PlanOfPair(rig.channels), {}, Clock::now()),
      report_maker_(report_command, session_folder / "report.txt"),
      report_file_{"text/html; charset=utf-8", "", false, true} {
  Subscribe();
  Show(Slot::kRig, RigJson(rig_));
  Show(Slot::kEvents, EventsJson(events_));  // none yet: the first is news to a page that is open
}

void DashboardNode::Subscribe() {
  const Channels& channels = rig_.channels;
  bus_.Subscribe<image_t>(
      channels.camera_image, Queue::kState, [this](const image_t& m) { OnImage(m); });
  bus_.Subscribe<pointcloud2_t>(
      channels.lidar_points, Queue::kState, [this](const pointcloud2_t& m) { OnPoints(m); });
  bus_.Subscribe<lidar_board_t>(
      channels.lidar_board, Queue::kState, [this](const lidar_board_t& m) {
        Show(Slot::kLidarBoard, LidarBoardJson(m));
      });
  bus_.Subscribe<camera_board_t>(
      channels.camera_board, Queue::kState, [this](const camera_board_t& m) {
        Try([&] { OnCameraBoard(m); });
      });
  bus_.Subscribe<next_pose_t>(channels.next_pose, Queue::kState, [this](const next_pose_t& m) {
    next_pose_ = m;
    ShowGuidance();
  });
  bus_.Subscribe<event_t>(
      channels.calib_event, Queue::kEvery, [this](const event_t& m) { OnEvent(m); });
  bus_.Subscribe<module_status_t>(
      channels.module_status, Queue::kEvery, [this](const module_status_t& m) {
        health_.Take(m, Clock::now());
      });
  const auto keep = [this](auto* newest) {
    return [this, newest](const auto& message) {
      *newest = message;
      is_state_new_ = true;
    };
  };
  bus_.Subscribe<samples_t>(channels.calib_samples, Queue::kState, keep(&samples_));
  bus_.Subscribe<voq_sets_t>(channels.voq_sets, Queue::kState, keep(&sets_));
  bus_.Subscribe<extrinsic_averaged_t>(
      channels.extrinsic_averaged, Queue::kState, keep(&averaged_));
  bus_.Subscribe<extrinsic_refined_t>(channels.extrinsic_refined, Queue::kState, keep(&refined_));
  bus_.Subscribe<assessment_t>(channels.calib_assessment, Queue::kState, keep(&assessment_));
}

std::string DashboardNode::State() const {
  return "running: " + std::to_string(server_.num_pages()) + " pages open";
}

void DashboardNode::StepIfDue() {
  if (Clock::now() >= next_step_) Step();
}

bool DashboardNode::Step() {
  next_step_ = Clock::now() + kStepPeriod;
  TakeCommands();
  LookAtSessionIfDue();
  ShowImageIfItsBoardIsLate();
  if (!std::exchange(is_state_new_, false)) return false;
  Try([this] { ShowSamples(); });
  Try([this] { ShowResult(); });
  return false;
}

std::optional<std::chrono::steady_clock::time_point> DashboardNode::NextStep() const {
  return next_step_;
}

void DashboardNode::Republish() {
  next_look_ = {};
  Step();
}

void DashboardNode::LookAtSessionIfDue() {
  const Clock::time_point now = Clock::now();
  if (now < next_look_) return;
  next_look_ = now + kLookPeriod;
  health_.Take(ReadSession(session_folder_, std::time(nullptr)), now);
  Show(Slot::kModules, ModulesJson(health_, rig_.channels, now));
  MakeReportIfWanted();
  Try([this] { ShowReport(); });
}

void DashboardNode::OnImage(const image_t& message) {
  StepIfDue();
  const Clock::time_point now = Clock::now();
  if (now < next_image_) return;
  ShowImageIfItsBoardIsLate();
  if (waiting_image_) return;
  next_image_ = now + Period(rig_.dashboard.image_rate_hz, server_.num_pages() > 0);
  Try([&] {
    waiting_image_ = ForPage(message, rig_.dashboard);
    waiting_since_ = now;
    const auto board = boards_.find(message.utime);
    if (board != boards_.end()) return ShowImage(board->second);
    if (now - last_board_at_ > kBoardsCome) ShowImage("");  // no detector is at work
  });
}

void DashboardNode::ShowImage(const std::string& board_json) {
  server_.Show(Slot::kImage, ImageFrame(*waiting_image_, board_json));
  waiting_image_.reset();
}

void DashboardNode::ShowImageIfItsBoardIsLate() {
  if (waiting_image_ && Clock::now() - waiting_since_ > kBoardPatience) ShowImage("");
}

void DashboardNode::OnPoints(const pointcloud2_t& message) {
  StepIfDue();
  const Clock::time_point now = Clock::now();
  if (now < next_cloud_) return;
  next_cloud_ = now + Period(rig_.dashboard.cloud_rate_hz, server_.num_pages() > 0);
  Try([&] {
    server_.Show(
        Slot::kCloud,
        CloudFrame(FromMessage(message), message.utime, Extrinsic(), rig_.camera, rig_.dashboard));
  });
}

void DashboardNode::OnCameraBoard(const camera_board_t& message) {
  board_camera_.reset();
  const std::string json = CameraBoardJson(message, rig_.camera);
  Show(Slot::kCameraBoard, json);
  const bool is_time_set_back = !boards_.empty() && message.utime < boards_.begin()->first;
  if (is_time_set_back) boards_.clear();
  boards_[message.utime] = json;
  if (boards_.size() > kMaxBoards) boards_.erase(boards_.begin());
  last_board_at_ = Clock::now();
  if (waiting_image_ && message.utime >= waiting_image_->utime) {
    ShowImage(message.utime == waiting_image_->utime ? json : "");
  }
  if (message.miss.empty()) board_camera_ = FromMessage(message).pose;
  ShowGuidance();
}

void DashboardNode::ShowGuidance() {
  if (!next_pose_) return;
  Show(Slot::kGuidance,
       GuidanceJson(*next_pose_, OrderFor(*next_pose_, board_camera_, rig_.camera)));
}

void DashboardNode::OnEvent(const event_t& message) {
  events_.push_front({message, 1 + TakeSameRejects(message)});
  if (events_.size() > kMaxEvents) events_.pop_back();
  Show(Slot::kEvents, EventsJson(events_));
}

int DashboardNode::TakeSameRejects(const event_t& message) {
  if (message.kind != "rejected") return 0;
  for (auto each = events_.begin(); each != events_.end(); ++each) {
    if (each->event.kind != "rejected") return 0;
    if (Cause(each->event) != Cause(message)) continue;
    const int count = each->count;
    events_.erase(each);
    return count;
  }
  return 0;
}

void DashboardNode::TakeCommands() {
  for (const PageRequest& request : server_.TakeCommands()) SendCommand(request);
  const std::int64_t num_refused = server_.num_refused_commands();
  if (num_refused > 0) SetCount("commands refused: too many at once", num_refused);
}

void DashboardNode::SendCommand(const PageRequest& request) {
  command_t message{};
  message.utime = WallClockUs();
  message.command = request.command;
  message.sample_id = request.sample_id;
  message.pair = PairName(rig_.lidar_name, rig_.camera_name);
  bus_.Publish(rig_.channels.calib_command, message);
  is_report_wanted_ = request.command == "finish";
  Count("commands: " + request.command);
}

void DashboardNode::ShowSamples() {
  if (!samples_) return;
  const bool is_judged =
      assessment_ && assessment_->problem.empty() && IsMadeFrom(*samples_, *assessment_);
  Show(Slot::kSamples,
       SamplesJson(*samples_,
                   TakenSamples(),
                   averaged_ ? &*averaged_ : nullptr,
                   is_judged ? &*assessment_ : nullptr,
                   rig_));
}

// An estimate of older samples stays in sight while a newer one is computed.
void DashboardNode::ShowResult() {
  if (!samples_ || !refined_ || !assessment_)
    return Show(Slot::kResult, NoResultJson("", WorkingOn()));
  const bool is_whole = refined_->problem.empty() && assessment_->problem.empty() &&
                        refined_->samples_sha256 == assessment_->samples_sha256;
  const std::string working_on = WorkingOn();
  if (!is_whole) {
    if (working_on.empty()) ShowNoResult(refined_->problem);
    return;
  }
  OfferExports();
  Show(Slot::kResult,
       ResultJson(*refined_,
                  *assessment_,
                  IsMadeFrom(*samples_, *assessment_),
                  working_on,
                  NamesOf(exports_)));
}

void DashboardNode::ShowNoResult(const std::string& problem) {
  exports_.clear();
  exports_sha256_.clear();
  OfferFiles();
  Show(Slot::kResult, NoResultJson(problem, ""));
}

// The file may come later than the message, or be of other samples: until it fits nothing is given
// out, and each new state looks again.
void DashboardNode::OfferExports() {
  if (exports_sha256_ == assessment_->samples_sha256) return;
  exports_.clear();
  exports_sha256_.clear();
  try {
    exports_ = ExportsOf(result_file_, assessment_->samples_sha256, rig_.camera);
    exports_sha256_ = assessment_->samples_sha256;
  } catch (const std::runtime_error& error) {
    spdlog::debug("nothing to export: {}", error.what());
    Count("looks for a result file that did not fit");
  }
  OfferFiles();
}

void DashboardNode::OfferFiles() {
  std::map<std::string, StaticFile> files = exports_;
  if (!report_.file.empty()) files[report_.file] = report_file_;
  server_.Offer(std::move(files));
}

bool DashboardNode::IsFinishedAndJudged() const {
  return samples_ && samples_->is_finished != 0 && assessment_ &&
         IsMadeFrom(*samples_, *assessment_);
}

// Where there is no result, more may have been seen since it was last told.
void DashboardNode::MakeReportIfWanted() {
  if (!is_report_wanted_ || !IsFinishedAndJudged() || report_maker_.IsAtWork()) return;
  is_report_wanted_ = false;
  if (assessment_->problem.empty() && FindReport(kReportName)) return;
  std::error_code ignored;  // there may be none
  std::filesystem::remove(session_folder_ / kNoResultName, ignored);
  tried_sha256_ = samples_->log_sha256;
  if (!report_maker_.Start()) spdlog::warn("the program that makes the report cannot be run");
}

void DashboardNode::ShowReport() {
  const SessionReport report = LookForReport();
  if (!(report == report_)) {
    report_ = report;
    OfferFiles();
  }
  Show(Slot::kReport, ReportJson(report_, session_folder_));
}

SessionReport DashboardNode::LookForReport() {
  if (!IsFinishedAndJudged()) return {};
  if (report_maker_.IsAtWork()) return {"making", ""};
  const char* const name = assessment_->problem.empty() ? kReportName : kNoResultName;
  if (FindReport(name)) return {"made", name};
  return {tried_sha256_ == samples_->log_sha256 ? "failed" : "", ""};
}

bool DashboardNode::FindReport(const std::string& name) {
  const std::filesystem::path file = session_folder_ / name;
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error) return false;
  const auto written = std::filesystem::last_write_time(file, error);
  if (error) return false;
  const auto found = std::make_tuple(name, size, written, samples_->log_sha256);
  if (found == read_) return is_read_of_samples_;
  std::string page = ReadWholeFile(file);
  read_ = found;
  is_read_of_samples_ = page.find(samples_->log_sha256) != std::string::npos;
  if (is_read_of_samples_) {
    report_file_.bytes = std::move(page);
    OfferFiles();
  }
  return is_read_of_samples_;
}

// A candidate may be chosen of a sample that was discarded since: then the samples as they came.
std::vector<BoardSample> DashboardNode::TakenSamples() const {
  if (averaged_ && IsMadeFrom(*samples_, *averaged_)) {
    return SamplesAsChosen(*samples_, averaged_->chosen);
  }
  return FromMessage(*samples_);
}

std::optional<Eigen::Isometry3d> DashboardNode::Extrinsic() const {
  if (refined_ && refined_->problem.empty()) return FromMessage(refined_->T_camera_lidar);
  if (averaged_ && averaged_->problem.empty()) return FromMessage(averaged_->T_camera_lidar);
  return {};
}

std::string DashboardNode::WorkingOn() const {
  if (!samples_ || samples_->num_samples == 0) return "";
  if (!sets_ || !IsMadeFrom(*samples_, *sets_)) return "choosing sets of poses";
  if (!averaged_ || !IsMadeFrom(*samples_, *averaged_)) return "calibrating each set";
  if (!refined_ || !IsMadeFrom(*samples_, *refined_)) return "refining over all poses";
  if (!assessment_ || !IsMadeFrom(*samples_, *assessment_)) return "judging the result";
  return "";
}

void DashboardNode::Show(Slot slot, std::string json) {
  std::string& shown = shown_.at(static_cast<std::size_t>(slot));
  if (json == shown) return;
  shown = json;
  server_.Show(slot, TextFrame(std::move(json)));
}

template <typename Shower>
void DashboardNode::Try(const Shower& show) try {
  show();
} catch (const std::exception& error) {  // of whatever library: a page ends no session
  spdlog::debug("not shown: {}", error.what());
  Count("messages that cannot be shown");
}

}  // namespace voqcal
