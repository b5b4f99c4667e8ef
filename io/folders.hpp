#pragma once

#include <filesystem>

namespace thermovox {

/// The folder that a file lies or is to lie in; "." for a bare name.
[[nodiscard]] std::filesystem::path folderOf(const std::filesystem::path& path);

/// The folder without a slash at its end: "hall/" is the folder "hall".
[[nodiscard]] std::filesystem::path withoutSlash(const std::filesystem::path& folder);

/// Makes the renaming of a file last: its folder's own entry has to reach the disk too.
void syncFolderOf(const std::filesystem::path& path);

/// Descriptor of a new file in the folder that has no name and so is gone with the process, however that
/// ends; below zero, with errno, when there can be none.
[[nodiscard]] int openUnnamedFile(const std::filesystem::path& folder);

}  // namespace thermovox
