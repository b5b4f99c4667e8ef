#include "apps/simulate/output_folder.hpp"

#include <system_error>

#include "projection/error.hpp"

namespace thermovox::simulate {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPartial = ".partial";

void refuseExisting(const fs::path& path) {
  if (!fs::exists(path)) return;
  throw DataError(path.string() + ": exists already, expected a new name (or --force to replace it)");
}

}  // namespace

fs::path namedFolder(const fs::path& out) {
  const fs::path normal = fs::absolute(out).lexically_normal();
  return normal.has_filename() ? normal : normal.parent_path();
}

fs::path beside(const fs::path& out, const std::string& ending) {
  const fs::path folder = namedFolder(out);
  return folder.parent_path() / (folder.filename().string() + ending);
}

OutputFolder::OutputFolder(const fs::path& out, const std::vector<std::string>& endings)
    : folder_(namedFolder(out)), endings_(endings) {
  if (!fs::is_directory(folder_) || !fs::is_empty(folder_)) refuseExisting(folder_);
  for (const std::string& ending : endings_) refuseExisting(beside(folder_, ending));
  removePartial();
}

OutputFolder::~OutputFolder() {
  removePartial();
}

fs::path OutputFolder::folder() const {
  return beside(folder_, kPartial);
}

fs::path OutputFolder::file(const std::string& ending) const {
  return beside(folder_, ending + kPartial);
}

void OutputFolder::commit() const {
  for (const std::string& ending : endings_) fs::rename(file(ending), beside(folder_, ending));
  fs::rename(folder(), folder_);
}

void OutputFolder::removePartial() const {
  std::error_code ignored;  // nothing there is the usual case
  fs::remove_all(folder(), ignored);
  for (const std::string& ending : endings_) fs::remove(file(ending), ignored);
}

}  // namespace thermovox::simulate
