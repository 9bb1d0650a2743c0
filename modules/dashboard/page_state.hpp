#pragma once

#include <cstdint>
#include <deque>
#include <set>
#include <string>
#include <vector>

#include "core/board/board_sample.hpp"
#include "dashboard/order.hpp"
#include "health/rig_health.hpp"
#include "rig/rig.hpp"
#include "voqcal/assessment_t.hpp"
#include "voqcal/camera_board_t.hpp"
#include "voqcal/event_t.hpp"
#include "voqcal/extrinsic_averaged_t.hpp"
#include "voqcal/extrinsic_refined_t.hpp"
#include "voqcal/lidar_board_t.hpp"
#include "voqcal/next_pose_t.hpp"
#include "voqcal/rig_extrinsics_t.hpp"
#include "voqcal/samples_t.hpp"

namespace voqcal {

// What the page is told, as JSON: pure functions. Every object has its slot's name as "kind";
// numbers that are not finite become null; names end in their units.

/// @param is_of_several  the rig has other pairs: says which this is.
std::string RigJson(const Rig& rig, bool is_of_several = false);

/// A pair of a rig of several, in the table of all.
struct PairRow {
  std::string name;  ///< PairName.
  std::string lidar;
  std::string camera;
  int num_samples = 0;
  std::string silent;   ///< Which of its sensors sends nothing any more; empty if none.
  std::string unheard;  ///< Which has sent nothing yet; the same.
  const rig_pair_t* result = nullptr;      ///< Null: none was heard of samples of this session.
  const next_pose_t* next_pose = nullptr;  ///< The same.
  bool is_current = true;                  ///< The result is of the newest samples.
};
/// All pairs, and what the rig that they are joined to is worth.
/// @param rig  null: none was heard.
/// @param next  the pair that the operator is sent to; empty: not known.
std::string PairsJson(const std::vector<PairRow>& rows,
                      const rig_extrinsics_t* rig,
                      const std::string& next);

/// @param samples  of `message`, with the candidates that were chosen.
/// @param averaged, assessment  of the same or earlier samples; null while there is none.
std::string SamplesJson(const samples_t& message,
                        const std::vector<BoardSample>& samples,
                        const extrinsic_averaged_t* averaged,
                        const assessment_t* assessment,
                        const Rig& rig);

/// The estimate with its uncertainty and verdict.
/// @param is_current  whether it is of the newest samples.
/// @param working_on  the stage that computes what is newer; empty if there is none.
/// @param exports  names of the files that can be had.
std::string ResultJson(const extrinsic_refined_t& refined,
                       const assessment_t& assessment,
                       bool is_current,
                       const std::string& working_on,
                       const std::vector<std::string>& exports);

/// That there is no estimate, and why.
std::string NoResultJson(const std::string& problem, const std::string& working_on);

/// What there is to read of the samples that "finish" left.
struct SessionReport {
  std::string state;  ///< "", "making", "made", "failed".
  std::string file;   ///< Its name, once made: kReportName, or kNoResultName where there is none.
  bool operator==(const SessionReport& other) const {
    return state == other.state && file == other.file;
  }
};
/// @param folder  where it is, and report.txt, which says why it is not.
std::string ReportJson(const SessionReport& report, const std::string& folder);

/// How each module is, what is wrong, and what comes of the four streams that samples are made of.
/// @param names_of_others  modules and sensors of other pairs, whose faults leave this one to work.
std::string ModulesJson(const RigHealth& health,
                        const Channels& channels,
                        RigHealth::Time now,
                        const std::set<std::string>& names_of_others = {});

std::string LidarBoardJson(const lidar_board_t& message);
std::string CameraBoardJson(const camera_board_t& message, const CameraModel& camera);
/// @param order  what it asks for, from where the board is now.
std::string GuidanceJson(const next_pose_t& message, const Order& order);

/// An event, and how often there was one of the same cause.
struct CountedEvent {
  event_t event;
  int count = 1;
};
/// @param events  the newest first.
std::string EventsJson(const std::deque<CountedEvent>& events);

}  // namespace voqcal
