#include "dashboard/dashboard_node.hpp"

#include <algorithm>
#include <ctime>
#include <map>
#include <utility>

#include "core/sensor_network/sensor_pair.hpp"
#include "health/session_programs.hpp"
#include "messaging/wall_clock.hpp"
#include "voqcal/command_t.hpp"

namespace voqcal {
namespace {

constexpr std::chrono::milliseconds kStepPeriod{50};  // a click must not seem to hang
constexpr std::chrono::milliseconds kLookPeriod{500};

std::string NameOf(const Rig& rig) { return PairName(rig.lidar_name, rig.camera_name); }

/// What faults may be of that do not touch this pair: modules and sensors of others.
std::set<std::string> NamesOfOthers(const SessionPlan& plan, const Rig& rig) {
  std::set<std::string> others;
  const Channels& channels = rig.channels;
  for (const Stream& stream : plan.streams) {
    const bool is_own =
        stream.channel == channels.lidar_points || stream.channel == channels.camera_image ||
        stream.channel == channels.lidar_board || stream.channel == channels.camera_board;
    if (!is_own) others.insert({stream.name, stream.sender});
  }
  const std::string collector = "sample_collector";
  for (const std::string& module : plan.modules) {
    const bool is_collector = ModuleOf(module) == collector && module != collector;
    if (is_collector && module != collector + "_" + NameOf(rig)) others.insert(module);
  }
  return others;
}

}  // namespace

DashboardNode::DashboardNode(const std::vector<ShownPair>& pairs,
                             const SessionPlan& plan,
                             Bus* bus,
                             DashboardServer* server,
                             const std::filesystem::path& session_folder)
    : bus_(*bus),
      server_(*server),
      session_folder_(session_folder),
      health_(plan, {}, Clock::now()) {
  for (const ShownPair& pair : pairs) {
    pages_.push_back(std::make_unique<PairPage>(
        pair, pages_.size(), pairs.size(), server, [this](const std::string& what) {
          Count(what);
        }));
    names_of_others_.push_back(NamesOfOthers(plan, pair.rig));
  }
  Subscribe();
  ShowPairs(Clock::now());
}

DashboardNode::DashboardNode(const Rig& rig,
                             Bus* bus,
                             DashboardServer* server,
                             const std::filesystem::path& session_folder,
                             const std::vector<std::string>& report_command)
    : DashboardNode({{rig, session_folder, report_command}},
                    PlanOfPair(rig.channels),
                    bus,
                    server,
                    session_folder) {}

void DashboardNode::Subscribe() {
  ToPages(&Channels::camera_image, Queue::kState, &PairPage::OnImage);
  ToPages(&Channels::lidar_points, Queue::kState, &PairPage::OnPoints);
  ToPages(&Channels::lidar_board, Queue::kState, &PairPage::OnLidarBoard);
  ToPages(&Channels::camera_board, Queue::kState, &PairPage::OnCameraBoard);
  ToPages(&Channels::next_pose, Queue::kState, &PairPage::OnNextPose);
  ToPages(&Channels::calib_event, Queue::kEvery, &PairPage::OnEvent);
  ToPages(&Channels::calib_samples, Queue::kState, &PairPage::OnSamples);
  ToPages(&Channels::voq_sets, Queue::kState, &PairPage::OnSets);
  ToPages(&Channels::extrinsic_averaged, Queue::kState, &PairPage::OnAveraged);
  ToPages(&Channels::extrinsic_refined, Queue::kState, &PairPage::OnRefined);
  ToPages(&Channels::calib_assessment, Queue::kState, &PairPage::OnAssessment);
  const Channels& channels = pages_.front()->rig().channels;
  bus_.Subscribe<module_status_t>(
      channels.module_status, Queue::kEvery, [this](const module_status_t& m) {
        health_.Take(m, Clock::now());
      });
  if (pages_.size() > 1) bus_.Keep(channels.rig_extrinsics, &rig_);
}

template <typename Message>
void DashboardNode::ToPages(std::string Channels::*channel,
                            Queue queue,
                            void (PairPage::*handler)(const Message&)) {
  std::map<std::string, std::vector<PairPage*>> readers;
  for (const auto& page : pages_) readers[page->rig().channels.*channel].push_back(page.get());
  for (const auto& [name, pages] : readers) {
    bus_.Subscribe<Message>(name, queue, [this, handler, pages = pages](const Message& message) {
      StepIfDue();
      for (PairPage* page : pages) (page->*handler)(message);
    });
  }
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
  for (const auto& page : pages_) page->Step();
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
  ShowPairs(now);
  for (std::size_t i = 0; i < pages_.size(); ++i) {
    const bool may_make_report = std::none_of(
        pages_.begin(), pages_.end(), [](const auto& each) { return each->IsMakingReport(); });
    pages_[i]->Look(health_, names_of_others_[i], may_make_report, now);
  }
}

void DashboardNode::ShowPairs(Clock::time_point now) {
  if (pages_.size() == 1) return;
  std::vector<PairRow> rows;
  for (std::size_t i = 0; i < pages_.size(); ++i) {
    const PairPage& page = *pages_[i];
    PairRow row;
    row.name = NameOf(page.rig());
    row.lidar = page.rig().lidar_name;
    row.camera = page.rig().camera_name;
    row.num_samples = page.num_samples();
    row.silent = SilentSensor(page.rig(), now);
    if (page.next_pose()) row.next_pose = &*page.next_pose();
    if (rig_) {
      const auto result =
          std::find_if(rig_->pairs.begin(), rig_->pairs.end(), [&](const rig_pair_t& each) {
            return each.name == row.name;
          });
      if (result != rig_->pairs.end()) row.result = &*result;
    }
    rows.push_back(row);
  }
  const std::string json = PairsJson(rows, rig_ ? &*rig_ : nullptr);
  for (const auto& page : pages_) page->Show(Slot::kPairs, json);
}

std::string DashboardNode::SilentSensor(const Rig& rig, Clock::time_point now) const {
  if (health_.FlowOf(rig.channels.lidar_points, now) == Flow::kSilent) return rig.lidar_name;
  if (health_.FlowOf(rig.channels.camera_image, now) == Flow::kSilent) return rig.camera_name;
  return "";
}

void DashboardNode::TakeCommands() {
  for (const PageRequest& request : server_.TakeCommands()) SendCommand(request);
  const std::int64_t num_refused = server_.num_refused_commands();
  if (num_refused > 0) SetCount("commands refused: too many at once", num_refused);
}

// A pair alone is not named by its page. Of several a number says which sample only with its pair.
void DashboardNode::SendCommand(const PageRequest& request) {
  command_t message{};
  message.utime = WallClockUs();
  message.command = request.command;
  message.sample_id = request.sample_id;
  message.pair = pages_.size() == 1 ? NameOf(pages_.front()->rig()) : request.pair;
  if (message.command == "discard" && message.pair.empty()) {
    return Count("commands refused: a sample of which pair?");
  }
  bus_.Publish(pages_.front()->rig().channels.calib_command, message);
  for (const auto& page : pages_) {
    const bool is_meant = message.pair.empty() || message.pair == NameOf(page->rig());
    if (is_meant) page->WantReport(request.command == "finish");
  }
  Count("commands: " + request.command);
}

}  // namespace voqcal
