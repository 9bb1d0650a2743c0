#include "rig_calibrator/pair_chain.hpp"

#include <array>
#include <utility>

namespace voqcal {

PairSession SessionOf(const Rig& rig) {
  PairSession session;
  session.lidar = rig.lidar_name;
  session.camera = rig.camera_name;
  session.lens = rig.camera;
  session.sampling = rig.sample_collector;
  return session;
}

PairChain::PairChain(const Rig& rig,
                     Bus* bus,
                     const std::filesystem::path& session_folder,
                     OnSceneImage on_image)
    : bus_(*bus),
      selector_(rig, bus),
      estimator_(rig, bus),
      scene_views_(ViewsOfSession(rig.board,
                                  rig.camera,
                                  rig.scene_check.view,
                                  session_folder / kSamplesLogName,
                                  std::move(on_image))),
      refiner_(rig, bus, scene_views_),
      assessor_(rig, bus, session_folder, scene_views_) {}

void PairChain::Run() {
  bus_.HandleWaiting();
  const std::array<Module*, 4> stages = {&selector_, &estimator_, &refiner_, &assessor_};
  for (Module* stage : stages) {
    while (stage->Step()) {
    }
    bus_.HandleWaiting();
  }
}

std::vector<const Module*> PairChain::modules() const {
  return {&selector_, &estimator_, &refiner_, &assessor_};
}

}  // namespace voqcal
