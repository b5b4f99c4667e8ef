#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace thermovox::simulate {

/// The folder without a slash at its end, so that it has a name; an absolute path.
[[nodiscard]] std::filesystem::path namedFolder(const std::filesystem::path& out);

/// The path beside it that has this ending after its name.
[[nodiscard]] std::filesystem::path beside(const std::filesystem::path& out, const std::string& ending);

/// A folder and some files beside it that appear together or not at all: they are made under other names
/// (with .partial after their own) and get theirs at the end. What a failed run would leave is removed.
class OutputFolder {
 public:
  /// `endings` of the files beside the folder. Throws DataError where one of them is there already, or the
  /// folder with something in it.
  OutputFolder(const std::filesystem::path& out, const std::vector<std::string>& endings);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  /// The name that the folder will have.
  [[nodiscard]] std::string name() const { return folder_.filename().string(); }
  /// Where to write for now.
  [[nodiscard]] std::filesystem::path folder() const;
  [[nodiscard]] std::filesystem::path file(const std::string& ending) const;

  /// Gives all of it its names, the folder last.
  void commit() const;

 private:
  void removePartial() const;

  std::filesystem::path folder_;
  std::vector<std::string> endings_;
};

}  // namespace thermovox::simulate
