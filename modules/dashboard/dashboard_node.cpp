#include "dashboard/dashboard_node.hpp"

#include <algorithm>
#include <ctime>
#include <iterator>
#include <map>
#include <utility>

#include "core/guidance/weakest_pair.hpp"
#include "core/sensor_network/sensor_pair.hpp"
#include "health/session_programs.hpp"
#include "messaging/convert_rig.hpp"
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
  for (const auto& page : pages_) rows.push_back(RowOf(*page, now));
  const std::string json = PairsJson(rows, rig_ ? &*rig_ : nullptr, NextPair(rows, now));
  for (const auto& page : pages_) page->Show(Slot::kPairs, json);
}

// What is of samples that a reset took away says nothing of those that came since.
PairRow DashboardNode::RowOf(const PairPage& page, Clock::time_point now) const {
  const Rig& rig = page.rig();
  PairRow row;
  row.name = NameOf(rig);
  row.lidar = rig.lidar_name;
  row.camera = rig.camera_name;
  row.num_samples = page.num_samples();
  row.silent = SensorThatIs(Flow::kSilent, rig, now);
  row.unheard = SensorThatIs(Flow::kNothingYet, rig, now);
  const auto& next = page.next_pose();
  if (next && page.IsOfThisSession(*next)) row.next_pose = &*next;
  const rig_pair_t* result = ResultOf(rig);
  if (result == nullptr) return row;
  const bool is_waiting = result->samples_revision < 0;
  row.is_current = is_waiting || page.IsCurrent(*result);
  if (is_waiting || page.IsOfThisSession(*result)) row.result = result;
  return row;
}

const rig_pair_t* DashboardNode::ResultOf(const Rig& rig) const {
  if (!rig_) return nullptr;
  const auto result =
      std::find_if(rig_->pairs.begin(), rig_->pairs.end(), [&](const rig_pair_t& each) {
        return each.name == NameOf(rig);
      });
  return result == rig_->pairs.end() ? nullptr : &*result;
}

std::string DashboardNode::SensorThatIs(Flow flow, const Rig& rig, Clock::time_point now) const {
  if (health_.FlowOf(rig.channels.lidar_points, now) == flow) return rig.lidar_name;
  if (health_.FlowOf(rig.channels.camera_image, now) == flow) return rig.camera_name;
  return "";
}

// rig_calibrator knows nothing of the sensors' health. Where none can be sampled (before the first
// frames, and after a recording's last) there is no better answer than its.
std::string DashboardNode::NextPair(const std::vector<PairRow>& rows, Clock::time_point now) {
  if (!rig_) return "";
  std::vector<PairNeed> needs;
  bool is_any_good = false;
  bool is_weakest_good = false;
  for (std::size_t i = 0; i < pages_.size(); ++i) {
    const Rig& rig = pages_[i]->rig();
    const rig_pair_t* result = ResultOf(rig);
    if (result == nullptr) return rig_->weakest_pair;
    PairNeed need = NeedOf(*result, rows[i].next_pose);
    if (rows[i].result == nullptr) need.grade.reset();  // of samples that a reset took away
    need.can_be_sampled = CanBeSampled(rig.channels, now);
    is_any_good = is_any_good || need.can_be_sampled;
    if (result->name == rig_->weakest_pair) is_weakest_good = need.can_be_sampled;
    needs.push_back(need);
  }
  if (is_weakest_good || !is_any_good) {
    next_pair_.reset();
    return rig_->weakest_pair;
  }
  next_pair_ = WeakestPair(needs, next_pair_);
  return NameOf(pages_[*next_pair_]->rig());
}

bool DashboardNode::CanBeSampled(const Channels& channels, Clock::time_point now) const {
  const std::string streams[] = {
      channels.lidar_points, channels.camera_image, channels.lidar_board, channels.camera_board};
  return std::all_of(std::begin(streams), std::end(streams), [&](const std::string& channel) {
    return health_.FlowOf(channel, now) == Flow::kFlows;
  });
}

void DashboardNode::TakeCommands() {
  for (const PageRequest& request : server_.TakeCommands()) SendCommand(request);
  const std::int64_t num_refused = server_.num_refused_commands();
  if (num_refused > 0) SetCount("commands refused: too many at once", num_refused);
}

// A pair alone is not named by its page.
void DashboardNode::SendCommand(const PageRequest& request) {
  command_t message{};
  message.utime = WallClockUs();
  message.command = request.command;
  message.sample_id = request.sample_id;
  message.pair = pages_.size() == 1 ? NameOf(pages_.front()->rig()) : request.pair;
  bus_.Publish(pages_.front()->rig().channels.calib_command, message);
  for (const auto& page : pages_) {
    const bool is_meant = message.pair.empty() || message.pair == NameOf(page->rig());
    if (is_meant) page->WantReport(request.command == "finish");
  }
  Count("commands: " + request.command);
}

}  // namespace voqcal
