#pragma once

#include <filesystem>
#include <string>

namespace thermovox {

/// The file that describes a folder (mission.yaml), given the folder or the file itself. `kind` says in
/// messages what the folder should be ("mission"). Throws DataError when nothing is there, and when it is a
/// file that cannot be a description: a station, a bag, a cloud, an image.
[[nodiscard]] std::filesystem::path descriptionFile(const std::filesystem::path& folder,
                                                    const std::string& name, const std::string& kind);

}  // namespace thermovox
