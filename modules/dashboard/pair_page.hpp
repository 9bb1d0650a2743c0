#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "dashboard/page_state.hpp"
#include "dashboard/report_maker.hpp"
#include "dashboard/sensor_frames.hpp"
#include "dashboard/server.hpp"
#include "health/rig_health.hpp"
#include "messaging/made_from.hpp"
#include "rig/rig.hpp"
#include "voqcal/image_t.hpp"
#include "voqcal/pointcloud2_t.hpp"
#include "voqcal/voq_sets_t.hpp"

namespace voqcal {

/// A lidar and a camera, alone or of a rig of several.
struct ShownPair {
  Rig rig;
  std::filesystem::path session_folder;     ///< Where the assessor leaves extrinsic.yaml.
  std::vector<std::string> report_command;  ///< What makes the session's report there.
};

/// What the modules say of one pair in, frames for the pages that show it out. Computes nothing of
/// its own.
class PairPage {
 public:
  using Clock = std::chrono::steady_clock;
  /// Counts something by name.
  using Counter = std::function<void(const std::string&)>;

  /// @param index   of the pair in the server's list.
  /// @param num_pairs  of that list; of several each says which it is.
  /// @param server  borrowed; must outlive this.
  PairPage(const ShownPair& shown,
           std::size_t index,
           std::size_t num_pairs,
           DashboardServer* server,
           Counter count);

  const Rig& rig() const { return rig_; }

  void OnImage(const image_t& message);
  void OnPoints(const pointcloud2_t& message);
  void OnLidarBoard(const lidar_board_t& message);
  void OnCameraBoard(const camera_board_t& message);
  void OnNextPose(const next_pose_t& message);
  void OnEvent(const event_t& message);
  void OnSamples(const samples_t& message);
  void OnSets(const voq_sets_t& message) { Keep(message, &sets_); }
  void OnAveraged(const extrinsic_averaged_t& message) { Keep(message, &averaged_); }
  void OnRefined(const extrinsic_refined_t& message) { Keep(message, &refined_); }
  void OnAssessment(const assessment_t& message) { Keep(message, &assessment_); }

  /// What is due since the last time.
  void Step();
  /// Shows the session's health and the report, which is begun if it is wanted.
  /// @param names_of_others  whose faults leave this pair to work (ModulesJson).
  /// @param may_make_report  no other pair's is being made.
  void Look(const RigHealth& health,
            const std::set<std::string>& names_of_others,
            bool may_make_report,
            Clock::time_point now);
  /// "finish" was clicked, or something else since.
  void WantReport(bool is_wanted) { is_report_wanted_ = is_wanted; }
  bool IsMakingReport() { return report_maker_.IsAtWork(); }

  /// Nothing is sent again that the pages know.
  void Show(Slot slot, std::string json);

  int num_samples() const { return samples_ ? samples_->num_samples : 0; }
  const std::optional<next_pose_t>& next_pose() const { return next_pose_; }
  /// Whether a message was made from samples that were this session's since the last reset.
  template <typename Message>
  bool IsOfThisSession(const Message& message) const {
    return heard_samples_.count({message.samples_revision, message.samples_sha256}) != 0;
  }
  /// Whether it was made from the newest.
  template <typename Message>
  bool IsCurrent(const Message& message) const {
    return samples_ && IsMadeFrom(*samples_, message);
  }

 private:
  template <typename Message>
  void Keep(const Message& message, std::optional<Message>* newest) {
    *newest = message;
    is_state_new_ = true;
  }

  /// With no page that shows it a frame now and then is kept ready for the next.
  Clock::duration Period(double rate_hz) const;
  /// Who begins to watch sees what is new at once.
  void NoteWhetherWatched();
  void ShowImage(const std::string& board_json);  ///< That which waits; empty: without a board.
  void ShowImageIfItsBoardIsLate();
  void TakeCameraBoard(const camera_board_t& message);
  /// The order changes with the board that is moved.
  void ShowGuidance();
  /// Removes the reject of the same cause since the last other event. @return its count.
  int TakeSameRejects(const event_t& message);

  void ShowSamples();
  void ShowResult();
  void ShowNoResult(const std::string& problem);
  void OfferExports();
  void OfferFiles();
  bool IsFinishedAndJudged() const;
  void MakeReportIfWanted();
  /// The report of the finished samples, whoever made it.
  void ShowReport();
  SessionReport LookForReport();
  /// Whether there is such a page and it names these samples; it is `report_file_` then. A page
  /// that has not changed since is not read again: it may be large.
  bool FindReport(const std::string& name);
  std::vector<BoardSample> TakenSamples() const;
  std::optional<Eigen::Isometry3d> Extrinsic() const;
  std::string WorkingOn() const;

  /// Calls `show` and shows what it gives; a message that contradicts itself is counted instead.
  template <typename Shower>
  void Try(const Shower& show);

  Rig rig_;
  std::size_t index_;
  std::size_t num_pairs_;
  std::string file_prefix_;  ///< Of its files on offer; of several its folder, "front_left/".
  DashboardServer& server_;
  Counter count_;
  std::filesystem::path session_folder_;
  std::filesystem::path result_file_;
  std::array<std::string, kNumSlots> shown_;
  Clock::time_point next_image_;
  Clock::time_point next_cloud_;
  bool is_watched_ = false;
  std::deque<CountedEvent> events_;         ///< The newest first; rejects of one cause together.
  bool is_state_new_ = false;               ///< Samples or what is made of them changed.
  std::optional<PageImage> waiting_image_;  ///< For the board that is found in it.
  Clock::time_point waiting_since_;
  std::map<std::int64_t, std::string> boards_;  ///< The newest, as JSON, by their images' times.
  Clock::time_point last_board_at_;
  std::optional<next_pose_t> next_pose_;
  std::optional<BoardPose> board_camera_;  ///< Where the camera sees it, in the newest image.
  std::optional<samples_t> samples_;
  /// Revision and hash of all since there were none.
  std::set<std::pair<std::int64_t, std::string>> heard_samples_;
  std::optional<voq_sets_t> sets_;
  std::optional<extrinsic_averaged_t> averaged_;
  std::optional<extrinsic_refined_t> refined_;
  std::optional<assessment_t> assessment_;
  std::map<std::string, StaticFile> exports_;  ///< The files on offer...
  std::string exports_sha256_;                 ///< ...and of which samples they are.
  ReportMaker report_maker_;
  bool is_report_wanted_ = false;
  std::string tried_sha256_;  ///< Of which samples a report was begun last.
  /// Of the report that was read last: name, size, time, and the samples that it should name...
  std::tuple<std::string, std::uintmax_t, std::filesystem::file_time_type, std::string> read_;
  bool is_read_of_samples_ = false;  ///< ...and whether it does.
  SessionReport report_;
  StaticFile report_file_;
};

}  // namespace voqcal
