#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "modules/nodes/node_test.hpp"
#include "sample_collector/sample_collector_node.hpp"
#include "support/sightings.hpp"
#include "support/temporary_folder.hpp"
#include "voqcal/event_t.hpp"
#include "voqcal/image_t.hpp"
#include "voqcal/pointcloud2_t.hpp"
#include "voqcal/samples_t.hpp"

namespace voqcal {

/// A collector to which a board is shown, stop by stop.
class SampleCollectorNodeTest : public ::testing::Test {
 protected:
  SampleCollectorNodeTest() { Restart(); }

  void Restart() {
    node_.reset();
    inbox_.reset();
    events_.reset();
    bus_ = std::make_unique<Bus>("memq://");
    node_ = std::make_unique<SampleCollectorNode>(rig_, bus_.get(), folder_.path());
    inbox_ = std::make_unique<test::Inbox<samples_t>>(bus_.get(), rig_.channels.calib_samples);
    events_ = std::make_unique<test::Inbox<event_t>>(bus_.get(), rig_.channels.calib_event);
  }

  /// The board rests at a pose over three frames, and a fourth that closes the third. Of the frames
  /// listed the collector also sees what the detectors saw.
  void ShowStop(int stop, const std::vector<std::size_t>& with_scene = {}) {
    const auto frames = test::StillFrames(samples_, stop);
    for (std::size_t i = 0; i < frames.size(); ++i) {
      if (std::count(with_scene.begin(), with_scene.end(), i) != 0) {
        pointcloud2_t sweep{};
        sweep.utime = frames[i].lidar.utime;
        sweep.seq = static_cast<std::int32_t>(i);
        test::Send(bus_.get(), rig_.channels.lidar_points, sweep);
        image_t image{};
        image.utime = frames[i].camera.utime;
        test::Send(bus_.get(), rig_.channels.camera_image, image);
      }
      test::Send(bus_.get(), rig_.channels.lidar_board, frames[i].lidar);
      test::Send(bus_.get(), rig_.channels.camera_board, frames[i].camera);
    }
  }

  void Command(const std::string& text, std::int64_t sample_id = 0, const std::string& pair = {}) {
    command_t command{};
    command.command = text;
    command.sample_id = sample_id;
    command.pair = pair;
    test::Send(bus_.get(), rig_.channels.calib_command, command);
  }

  /// A second passes.
  void Republish() {
    node_->Step();
    node_->Republish();
    test::HandleAll(bus_.get());
  }

  std::vector<std::int64_t> Ids() const { return IdsOf(SamplesWithout(node_->samples(), {})); }
  const samples_t& last() const { return inbox_->messages.back(); }
  const event_t& last_event() const { return events_->messages.back(); }

  Rig rig_ = test::TestRig();
  test::TemporaryFolder folder_;
  std::vector<BoardSample> samples_ = test::SynthesizeSamples({});
  std::unique_ptr<Bus> bus_;
  std::unique_ptr<SampleCollectorNode> node_;
  std::unique_ptr<test::Inbox<samples_t>> inbox_;
  std::unique_ptr<test::Inbox<event_t>> events_;
};

}  // namespace voqcal
