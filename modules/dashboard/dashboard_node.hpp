#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "dashboard/page_state.hpp"
#include "dashboard/report_maker.hpp"
#include "dashboard/sensor_frames.hpp"
#include "dashboard/server.hpp"
#include "health/rig_health.hpp"
#include "messaging/bus.hpp"
#include "messaging/module.hpp"
#include "rig/rig.hpp"
#include "voqcal/image_t.hpp"
#include "voqcal/pointcloud2_t.hpp"
#include "voqcal/voq_sets_t.hpp"

namespace voqcal {

/// Everything that the modules say in, pages out; and the other way, the operator's clicks as
/// CALIB_COMMAND. Computes nothing of its own.
class DashboardNode : public Module {
 public:
  /// @param bus, server  borrowed; must outlive the node.
  /// @param session_folder  where the assessor leaves extrinsic.yaml.
  /// @param report_command  what makes the session's report there; run once "finish" was clicked.
  DashboardNode(const Rig& rig,
                Bus* bus,
                DashboardServer* server,
                const std::filesystem::path& session_folder,
                const std::vector<std::string>& report_command);

  std::string Name() const override { return "dashboard"; }
  std::string State() const override;
  bool Step() override;
  std::optional<std::chrono::steady_clock::time_point> NextStep() const override;
  void Republish() override;

 private:
  using Clock = std::chrono::steady_clock;

  void Subscribe();
  /// Step is for when no message waits; under load that may be never.
  void StepIfDue();
  void TakeCommands();
  void OnImage(const image_t& message);
  void ShowImage(const std::string& board_json);  ///< That which waits; empty: without a board.
  void ShowImageIfItsBoardIsLate();
  void OnPoints(const pointcloud2_t& message);
  void OnCameraBoard(const camera_board_t& message);
  /// The order changes with the board that is moved.
  void ShowGuidance();
  void OnEvent(const event_t& message);
  /// Removes the reject of the same cause since the last other event. @return its count.
  int TakeSameRejects(const event_t& message);
  void SendCommand(const PageRequest& request);

  /// Faults are to be seen at once: more often than heartbeats come.
  void LookAtSessionIfDue();
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

  /// Nothing is sent again that the pages know.
  void Show(Slot slot, std::string json);
  /// Calls `show` and shows what it gives; a message that contradicts itself is counted instead.
  template <typename Shower>
  void Try(const Shower& show);

  Rig rig_;
  Bus& bus_;
  DashboardServer& server_;
  std::filesystem::path session_folder_;
  std::filesystem::path result_file_;
  std::array<std::string, kNumSlots> shown_;
  Clock::time_point next_step_;
  Clock::time_point next_image_;
  Clock::time_point next_cloud_;
  Clock::time_point next_look_;
  RigHealth health_;
  std::deque<CountedEvent> events_;         ///< The newest first; rejects of one cause together.
  bool is_state_new_ = false;               ///< Samples or what is made of them changed.
  std::optional<PageImage> waiting_image_;  ///< For the board that is found in it.
  Clock::time_point waiting_since_;
  std::map<std::int64_t, std::string> boards_;  ///< The newest, as JSON, by their images' times.
  Clock::time_point last_board_at_;
  std::optional<next_pose_t> next_pose_;
  std::optional<BoardPose> board_camera_;  ///< Where the camera sees it, in the newest image.
  std::optional<samples_t> samples_;
  std::optional<voq_sets_t> sets_;
  std::optional<extrinsic_averaged_t> averaged_;
  std::optional<extrinsic_refined_t> refined_;
  std::optional<assessment_t> assessment_;
  std::map<std::string, StaticFile> exports_;  ///< The files on offer...
  std::string exports_sha256_;                 ///< ...and of which samples they are.
  ReportMaker report_maker_;
  bool is_report_wanted_ = false;  ///< "finish" was clicked.
  std::string tried_sha256_;       ///< Of which samples a report was begun last.
  /// Of the report that was read last: name, size, time, and the samples that it should name...
  std::tuple<std::string, std::uintmax_t, std::filesystem::file_time_type, std::string> read_;
  bool is_read_of_samples_ = false;  ///< ...and whether it does.
  SessionReport report_;
  StaticFile report_file_;
};

}  // namespace voqcal
