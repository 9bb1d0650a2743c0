#include "dashboard/pair_page.hpp"

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
#include "result/result_file.hpp"

namespace voqcal {
namespace {

constexpr std::size_t kMaxEvents = 40;
// An image is shown with the board that was found in it, or without if that takes longer.
constexpr std::chrono::milliseconds kBoardPatience{500};
constexpr std::chrono::seconds kBoardsCome{2};
constexpr std::size_t kMaxBoards = 20;

/// What rejects have in common: "the board moves: 0.12 m" is the same as "the board moves: 0.13 m".
std::string Cause(const event_t& event) {
  return event.kind + " " + event.reason.substr(0, event.reason.find(':'));
}

/// Within the session of all: "front_left/".
std::string FilePrefix(const Rig& rig, std::size_t num_pairs) {
  return num_pairs == 1 ? "" : PairName(rig.lidar_name, rig.camera_name) + "/";
}

std::vector<std::string> NamesOf(const std::map<std::string, StaticFile>& files) {
  std::vector<std::string> names;
  for (const auto& [name, file] : files) names.push_back(name);
  return names;
}

}  // namespace

PairPage::PairPage(const ShownPair& shown,
                   std::size_t index,
                   std::size_t num_pairs,
                   DashboardServer* server,
                   Counter count)
    : rig_(shown.rig),
      index_(index),
      num_pairs_(num_pairs),
      file_prefix_(FilePrefix(rig_, num_pairs)),
      server_(*server),
      count_(std::move(count)),
      session_folder_(shown.session_folder),
      result_file_(session_folder_ / "extrinsic.yaml"),
      report_maker_(shown.report_command, session_folder_ / "report.txt"),
      report_file_{"text/html; charset=utf-8", "", false, true} {
  Show(Slot::kRig, RigJson(rig_, num_pairs > 1));
  Show(Slot::kEvents, EventsJson(events_));  // none yet: the first is news to a page that is open
}

void PairPage::Step() {
  ShowImageIfItsBoardIsLate();
  if (!std::exchange(is_state_new_, false)) return;
  Try([this] { ShowSamples(); });
  Try([this] { ShowResult(); });
}

void PairPage::Look(const RigHealth& health,
                    const std::set<std::string>& names_of_others,
                    bool may_make_report,
                    Clock::time_point now) {
  Show(Slot::kModules, ModulesJson(health, rig_.channels, now, names_of_others));
  if (may_make_report) MakeReportIfWanted();
  Try([this] { ShowReport(); });
}

PairPage::Clock::duration PairPage::Period(double rate_hz) const {
  const std::chrono::duration<double> period(is_watched_ ? 1.0 / rate_hz
                                                         : static_cast<double>(num_pairs_));
  return std::chrono::duration_cast<Clock::duration>(period);
}

void PairPage::NoteWhetherWatched() {
  const bool is_watched = server_.num_pages(index_) > 0;
  if (is_watched && !is_watched_) next_image_ = next_cloud_ = {};
  is_watched_ = is_watched;
}

void PairPage::OnImage(const image_t& message) {
  NoteWhetherWatched();
  const Clock::time_point now = Clock::now();
  if (now < next_image_) return;
  ShowImageIfItsBoardIsLate();
  if (waiting_image_) return;
  next_image_ = now + Period(rig_.dashboard.image_rate_hz);
  Try([&] {
    waiting_image_ = ForPage(message, rig_.dashboard);
    waiting_since_ = now;
    const auto board = boards_.find(message.utime);
    if (board != boards_.end()) return ShowImage(board->second);
    if (now - last_board_at_ > kBoardsCome) ShowImage("");  // no detector is at work
  });
}

void PairPage::ShowImage(const std::string& board_json) {
  server_.Show(Slot::kImage, ImageFrame(*waiting_image_, board_json), index_);
  waiting_image_.reset();
}

void PairPage::ShowImageIfItsBoardIsLate() {
  if (waiting_image_ && Clock::now() - waiting_since_ > kBoardPatience) ShowImage("");
}

void PairPage::OnPoints(const pointcloud2_t& message) {
  NoteWhetherWatched();
  const Clock::time_point now = Clock::now();
  if (now < next_cloud_) return;
  next_cloud_ = now + Period(rig_.dashboard.cloud_rate_hz);
  Try([&] {
    server_.Show(
        Slot::kCloud,
        CloudFrame(FromMessage(message), message.utime, Extrinsic(), rig_.camera, rig_.dashboard),
        index_);
  });
}

void PairPage::OnLidarBoard(const lidar_board_t& message) {
  Show(Slot::kLidarBoard, LidarBoardJson(message));
}

void PairPage::OnCameraBoard(const camera_board_t& message) {
  Try([&] { TakeCameraBoard(message); });
}

void PairPage::OnNextPose(const next_pose_t& message) {
  next_pose_ = message;
  ShowGuidance();
}

void PairPage::TakeCameraBoard(const camera_board_t& message) {
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

void PairPage::ShowGuidance() {
  if (!next_pose_) return;
  Show(Slot::kGuidance,
       GuidanceJson(*next_pose_, OrderFor(*next_pose_, board_camera_, rig_.camera)));
}

void PairPage::OnSamples(const samples_t& message) {
  if (message.num_samples == 0) heard_samples_.clear();
  heard_samples_.insert({message.revision, message.log_sha256});
  Keep(message, &samples_);
}

void PairPage::OnEvent(const event_t& message) {
  events_.push_front({message, 1 + TakeSameRejects(message)});
  if (events_.size() > kMaxEvents) events_.pop_back();
  Show(Slot::kEvents, EventsJson(events_));
}

int PairPage::TakeSameRejects(const event_t& message) {
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

void PairPage::ShowSamples() {
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
void PairPage::ShowResult() {
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

void PairPage::ShowNoResult(const std::string& problem) {
  exports_.clear();
  exports_sha256_.clear();
  OfferFiles();
  Show(Slot::kResult, NoResultJson(problem, ""));
}

// The file may come later than the message, or be of other samples: until it fits nothing is given
// out, and each new state looks again.
void PairPage::OfferExports() {
  if (exports_sha256_ == assessment_->samples_sha256) return;
  exports_.clear();
  exports_sha256_.clear();
  try {
    exports_ = ExportsOf(result_file_, assessment_->samples_sha256, rig_.camera);
    exports_sha256_ = assessment_->samples_sha256;
  } catch (const std::runtime_error& error) {
    spdlog::debug("nothing to export: {}", error.what());
    count_("looks for a result file that did not fit");
  }
  OfferFiles();
}

void PairPage::OfferFiles() {
  std::map<std::string, StaticFile> files = exports_;
  if (!report_.file.empty()) files[report_.file] = report_file_;
  std::map<std::string, StaticFile> offered;
  for (auto& [name, file] : files) offered[file_prefix_ + name] = std::move(file);
  server_.Offer(std::move(offered), index_);
}

bool PairPage::IsFinishedAndJudged() const {
  return samples_ && samples_->is_finished != 0 && assessment_ &&
         IsMadeFrom(*samples_, *assessment_);
}

// Where there is no result, more may have been seen since it was last told.
void PairPage::MakeReportIfWanted() {
  if (!is_report_wanted_ || !IsFinishedAndJudged() || report_maker_.IsAtWork()) return;
  is_report_wanted_ = false;
  if (assessment_->problem.empty() && FindReport(kReportName)) return;
  std::error_code ignored;  // there may be none
  std::filesystem::remove(session_folder_ / kNoResultName, ignored);
  tried_sha256_ = samples_->log_sha256;
  if (!report_maker_.Start()) spdlog::warn("the program that makes the report cannot be run");
}

void PairPage::ShowReport() {
  const SessionReport report = LookForReport();
  if (!(report == report_)) {
    report_ = report;
    OfferFiles();
  }
  Show(Slot::kReport, ReportJson(report_, session_folder_));
}

SessionReport PairPage::LookForReport() {
  if (!IsFinishedAndJudged()) return {};
  if (report_maker_.IsAtWork()) return {"making", ""};
  const char* const name = assessment_->problem.empty() ? kReportName : kNoResultName;
  if (FindReport(name)) return {"made", name};
  return {tried_sha256_ == samples_->log_sha256 ? "failed" : "", ""};
}

bool PairPage::FindReport(const std::string& name) {
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
std::vector<BoardSample> PairPage::TakenSamples() const {
  if (averaged_ && IsMadeFrom(*samples_, *averaged_)) {
    return SamplesAsChosen(*samples_, averaged_->chosen);
  }
  return FromMessage(*samples_);
}

std::optional<Eigen::Isometry3d> PairPage::Extrinsic() const {
  if (refined_ && refined_->problem.empty()) return FromMessage(refined_->T_camera_lidar);
  if (averaged_ && averaged_->problem.empty()) return FromMessage(averaged_->T_camera_lidar);
  return {};
}

std::string PairPage::WorkingOn() const {
  if (!samples_ || samples_->num_samples == 0) return "";
  if (!sets_ || !IsMadeFrom(*samples_, *sets_)) return "choosing sets of poses";
  if (!averaged_ || !IsMadeFrom(*samples_, *averaged_)) return "calibrating each set";
  if (!refined_ || !IsMadeFrom(*samples_, *refined_)) return "refining over all poses";
  if (!assessment_ || !IsMadeFrom(*samples_, *assessment_)) return "judging the result";
  return "";
}

void PairPage::Show(Slot slot, std::string json) {
  std::string& shown = shown_.at(static_cast<std::size_t>(slot));
  if (json == shown) return;
  shown = json;
  server_.Show(slot, TextFrame(std::move(json)), index_);
}

template <typename Shower>
void PairPage::Try(const Shower& show) try {
  show();
} catch (const std::exception& error) {  // of whatever library: a page ends no session
  spdlog::debug("not shown: {}", error.what());
  count_("messages that cannot be shown");
}

}  // namespace voqcal
