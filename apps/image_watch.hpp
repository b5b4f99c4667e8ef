#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <set>
#include <string>

#include "apps/image_job.hpp"
#include "io/camera_folder.hpp"

namespace thermovox {

/// What `thermovox image --watch` does besides turning one image into a file.
struct ImageWatch {
  std::filesystem::path folder;  ///< of the camera
  std::filesystem::path
      out_folder;  ///< gets a file for every image, under its name and folder with an ending more
  std::string ending = ".tiff";
  CameraFolder::Options camera;
  bool pass_over = false;                                 ///< what is there at the start
  std::optional<std::size_t> most;                        ///< images, then it ends
  std::optional<std::chrono::milliseconds> longest_idle;  ///< without a new image, then it ends
};

/// Turns every image that appears into a file and prints a line for it, until there have been enough or none
/// for long enough. An image that holds no temperatures or is damaged is told and passed over, and so is one
/// whose file was there before, unless existing files are replaced. Throws DataError when a file cannot be
/// written.
void watchImages(ImageJob job, const ImageWatch& watch);

}  // namespace thermovox
