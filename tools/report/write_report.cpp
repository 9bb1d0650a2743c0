#include "report/write_report.hpp"

#include "common/run_program.hpp"
#include "common/scratch_folder.hpp"
#include "files/atomic_file.hpp"
#include "messaging/session_scenes.hpp"
#include "report/overlays.hpp"
#include "report/result_json.hpp"
#include "result/result_file.hpp"

namespace voqcal {

std::string WriteReport(const Rig& rig,
                        const OfflineRun& run,
                        const std::filesystem::path& folder) {
  const std::filesystem::path json = folder / kResultJsonName;
  WriteFileAtomically(json, ResultJson(rig, run));
  const ScratchFolder overlays(folder / "overlays");
  WriteOverlays(rig, run, folder / kSamplesLogName, overlays.path());
  return RunProgram({ScriptOfTools("report/make_report.py"),
                     json,
                     overlays.path(),
                     folder / kReportName,
                     FileBesidePrograms("lib/report.html.j2.code")});
}

}  // namespace voqcal
