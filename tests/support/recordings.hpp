#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>

namespace thermovox::test {

/// The folder of real recordings and simulated truth: THERMOVOX_DATA, or else `shared/data` beside the source
/// tree or one of the folders above it. nullopt where there is none; a test that wants it then skips.
[[nodiscard]] inline std::optional<std::filesystem::path> recordings() {
  namespace fs = std::filesystem;
  if (const char* named = std::getenv("THERMOVOX_DATA"); named != nullptr && *named != '\0') {
    return fs::is_directory(named) ? std::optional<fs::path>(named) : std::nullopt;
  }
  for (fs::path folder = THERMOVOX_SOURCE_DIR;; folder = folder.parent_path()) {
    if (fs::is_directory(folder / "shared" / "data")) return folder / "shared" / "data";
    if (folder == folder.parent_path()) return std::nullopt;
  }
}

/// An empty folder of its own for one test; it is removed with all its content when the object goes.
class TestFolder {
 public:
  TestFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "thermovox-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot create a folder " + name);
    path_ = name;
  }
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;
  ~TestFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] std::filesystem::path operator/(std::string_view name) const { return path_ / name; }

  /// Writes a file (folders on the way are made) and returns its path.
  std::filesystem::path write(std::string_view name, std::string_view content) const {
    const std::filesystem::path file = path_ / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream stream(file, std::ios::binary);
    stream << content;
    if (!stream.flush()) throw std::runtime_error("cannot write " + file.string());
    return file;
  }

 private:
  std::filesystem::path path_;
};

/// The bytes of a file.
[[nodiscard]] inline std::string bytesOf(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw std::runtime_error("cannot read " + file.string());
  std::ostringstream bytes;
  bytes << stream.rdbuf();
  return std::move(bytes).str();
}

/// The message of the error of this type that the callable throws; a failed expectation and "" otherwise.
template <typename Exception, typename Callable>
[[nodiscard]] std::string messageOf(Callable&& callable) {
  try {
    callable();
  } catch (const Exception& error) {
    return error.what();
  } catch (const std::exception& error) {
    ADD_FAILURE() << "threw another error: " << error.what();
    return "";
  }
  ADD_FAILURE() << "threw nothing";
  return "";
}

}  // namespace thermovox::test

/// Leaves the test as skipped when the recordings are not there.
#define THERMOVOX_NEEDS_RECORDINGS()                                                    \
  if (!thermovox::test::recordings()) {                                                 \
    GTEST_SKIP() << "the recordings are not there: set THERMOVOX_DATA to their folder"; \
  }                                                                                     \
  static_assert(true)
