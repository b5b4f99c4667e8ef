#include "apps/simulate/mission_writer.hpp"

#include "apps/simulate/instrument_files.hpp"
#include "apps/simulate/mission_files.hpp"
#include "apps/simulate/output_folder.hpp"
#include "apps/simulate/truth.hpp"
#include "projection/error.hpp"

namespace thermovox::simulate {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTruth = ".truth.json";

}  // namespace

fs::path truthPath(const fs::path& out) {
  return beside(out, kTruth);
}

void simulateMission(const SimulationOptions& options, const fs::path& out) {
  const Simulation simulation(options);
  const OutputFolder output(out, {kTruth});
  const fs::path folder = output.folder();
  try {
    fs::create_directories(folder);
    writeDescriptions(simulation, output.name(), folder);
    writeTrajectory(simulation, folder);
    writeThermalFrames(simulation, folder);
    if (simulation.rig().visible_camera) writeVisiblePictures(simulation, folder);
    writeText(output.file(kTruth), truthText(simulation, writeLaser(simulation, folder)));
    output.commit();
  } catch (const fs::filesystem_error& error) {
    throw DataError(error.path1().string() + ": could not be written (" + error.code().message() +
                    "), expected a folder with room for it");
  }
}

}  // namespace thermovox::simulate
