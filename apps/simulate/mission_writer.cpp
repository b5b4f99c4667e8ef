#include "apps/simulate/mission_writer.hpp"

#include <string>
#include <system_error>

#include "apps/simulate/instrument_files.hpp"
#include "apps/simulate/mission_files.hpp"
#include "apps/simulate/truth.hpp"
#include "projection/error.hpp"

namespace thermovox::simulate {
namespace {

namespace fs = std::filesystem;

/// The folder without a slash at its end, so that it has a name.
fs::path named(const fs::path& out) {
  const fs::path normal = fs::absolute(out).lexically_normal();
  return normal.has_filename() ? normal : normal.parent_path();
}

fs::path besides(const fs::path& out, const std::string& ending) {
  return out.parent_path() / (out.filename().string() + ending);
}

void refuseExisting(const fs::path& path) {
  if (!fs::exists(path)) return;
  throw DataError(path.string() + ": exists already, expected a new name (or --force to replace it)");
}

/// Removes what a failed run would leave behind.
class Leftovers {
 public:
  Leftovers(fs::path folder, fs::path truth) : folder_(std::move(folder)), truth_(std::move(truth)) {
    remove();
  }
  ~Leftovers() { remove(); }
  Leftovers(const Leftovers&) = delete;
  Leftovers& operator=(const Leftovers&) = delete;

 private:
  void remove() const {
    std::error_code ignored;  // nothing there is the usual case
    fs::remove_all(folder_, ignored);
    fs::remove(truth_, ignored);
  }
  fs::path folder_;
  fs::path truth_;
};

}  // namespace

fs::path truthPath(const fs::path& out) {
  return besides(named(out), ".truth.json");
}

void simulateMission(const SimulationOptions& options, const fs::path& out) {
  const Simulation simulation(options);
  const fs::path folder = named(out);
  const fs::path truth = truthPath(out);
  if (!fs::is_directory(folder) || !fs::is_empty(folder)) refuseExisting(folder);
  refuseExisting(truth);
  const fs::path new_folder = besides(folder, ".partial");
  const fs::path new_truth = besides(folder, ".truth.json.partial");
  const Leftovers leftovers(new_folder, new_truth);
  try {
    fs::create_directories(new_folder);
    writeDescriptions(simulation, folder.filename().string(), new_folder);
    writeTrajectory(simulation, new_folder);
    writeThermalFrames(simulation, new_folder);
    if (simulation.rig().visible_camera) writeVisiblePictures(simulation, new_folder);
    writeText(new_truth, truthText(simulation, writeLaser(simulation, new_folder)));
    fs::rename(new_truth, truth);
    fs::rename(new_folder, folder);
  } catch (const fs::filesystem_error& error) {
    throw DataError(error.path1().string() + ": could not be written (" + error.code().message() +
                    "), expected a folder with room for it");
  }
}

}  // namespace thermovox::simulate
