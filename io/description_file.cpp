#include "io/description_file.hpp"

#include <array>
#include <fstream>
#include <string_view>
#include <system_error>
#include <utility>

#include "io/input_file.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

namespace fs = std::filesystem;

/// The other things that one might give are named.
void refuseOtherKinds(const fs::path& file, const std::string& kind) {
  using namespace std::string_view_literals;
  constexpr std::array<std::pair<std::string_view, std::string_view>, 9> kinds{
      {{"SQLite format 3\0"sv, "a station"sv},
       {"#ROSBAG"sv, "a ROS bag (not read yet)"sv},
       {"# .PCD"sv, "a point cloud"sv},
       {"ply"sv, "a point cloud"sv},
       {"II*\0"sv, "a TIFF image"sv},
       {"MM\0*"sv, "a TIFF image"sv},
       {"\x89PNG"sv, "a picture"sv},
       {"\xFF\xD8\xFF"sv, "a picture"sv},
       {"# Octomap OcTree"sv, "an OctoMap"sv}}};
  std::string head(64, '\0');
  std::ifstream stream = openInput(file);
  stream.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(stream.gcount()));
  std::string_view found = head.find('\0') == std::string::npos ? ""sv : "a binary file"sv;
  for (const auto& [magic, what] : kinds) {
    if (head.starts_with(magic)) found = what;
  }
  if (!found.empty()) {
    throw DataError(file.string() + ": is " + std::string(found) + ", expected a " + kind + " folder");
  }
}

}  // namespace

fs::path descriptionFile(const fs::path& folder, const std::string& name, const std::string& kind) {
  std::error_code error;
  if (fs::is_directory(folder, error)) return folder / name;
  if (!fs::exists(folder, error)) {
    throw DataError(folder.string() + ": no such " + kind + ", expected a folder with a " + name);
  }
  refuseOtherKinds(folder, kind);
  return folder;
}

}  // namespace thermovox
