// voqcal_figures: how accurate the algorithms are, over many seeded runs. One subcommand a figure.

#include "common/tool_main.hpp"
#include "figures/figures.hpp"

int main(int argc, char** argv) {
  CLI::App app("Measures the accuracy of voqcal's algorithms over many seeded runs.",
               "voqcal_figures");
  app.require_subcommand(1);
  voqcal::AddAccuracy(&app);
  voqcal::AddCameraDetection(&app);
  voqcal::AddConsistency(&app);
  voqcal::AddCoverage(&app);
  voqcal::AddField(&app);
  voqcal::AddGuidance(&app);
  voqcal::AddGuidanceBound(&app);
  voqcal::AddLidarDetection(&app);
  voqcal::AddMethods(&app);
  voqcal::AddMonitor(&app);
  voqcal::AddRepeatability(&app);
  voqcal::AddRig(&app);
  voqcal::AddSceneCheckPower(&app);
  voqcal::AddSubsets(&app);
  voqcal::AddVerdict(&app);
  voqcal::AddWrongModels(&app);
  return voqcal::RunTool(&app, argc, argv, [] {});
}
