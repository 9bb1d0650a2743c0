#pragma once

#include <CLI/CLI.hpp>

namespace voqcal {

// One function a figure, in a file of its own. Each adds a subcommand with its flags (a seed and a
// number of runs among them) and a callback that prints a table: what was asked, what was reached.
void AddAccuracy(CLI::App* app);
void AddConsistency(CLI::App* app);
void AddCoverage(CLI::App* app);
void AddField(CLI::App* app);
void AddGuidance(CLI::App* app);
void AddGuidanceBound(CLI::App* app);
void AddMethods(CLI::App* app);
void AddMonitor(CLI::App* app);
void AddRepeatability(CLI::App* app);
void AddRig(CLI::App* app);
void AddSubsets(CLI::App* app);
void AddVerdict(CLI::App* app);
void AddWrongModels(CLI::App* app);

void AddCameraDetection(CLI::App* app);
void AddLidarDetection(CLI::App* app);
void AddSceneCheckPower(CLI::App* app);

}  // namespace voqcal
