#include "apps/image_watch.hpp"

#include <spdlog/spdlog.h>

#include <fstream>
#include <iostream>
#include <string_view>
#include <vector>

#include "projection/error.hpp"

namespace thermovox {

namespace fs = std::filesystem;
namespace {

using std::chrono::milliseconds;

/// DCIM/101FLIR/0007.jpg becomes OUT/DCIM/101FLIR/0007.jpg.tiff: what is called 0007.tiff is another image.
fs::path outputOf(const fs::path& image, const ImageWatch& watch) {
  fs::path out = watch.out_folder / image.lexically_relative(watch.folder);
  out += watch.ending;
  return out;
}

void makeFolderOf(const fs::path& file) {
  std::error_code error;
  fs::create_directories(file.parent_path(), error);
  if (error) throw DataError(file.parent_path().string() + ": cannot be made (" + error.message() + ")");
}

bool isThere(const fs::path& file) {
  std::error_code unknown;
  return fs::exists(file, unknown);
}

/// Whether every byte of a file can be read; the kernel may know the name of one whose card has gone.
bool isWhole(const fs::path& file) {
  std::error_code error;
  const std::uintmax_t size = fs::file_size(file, error);
  if (error) return false;
  std::ifstream stream(file, std::ios::binary);
  std::vector<char> piece(1 << 16);
  std::uintmax_t read = 0;
  while (stream.read(piece.data(), static_cast<std::streamsize>(piece.size())) || stream.gcount() > 0) {
    read += static_cast<std::uintmax_t>(stream.gcount());
  }
  return !stream.bad() && read >= size;
}

/// Writes the file of an image that has just appeared; false when there is none to write.
bool take(const ImageJob& job, const fs::path& image, const fs::path& out, CameraFolder& images) {
  if (job.existing == Existing::refuse && isThere(out)) {
    spdlog::info("{}: was there before, {} is passed over (--force replaces it)", out.string(),
                 image.string());
    return false;
  }
  makeFolderOf(out);
  try {
    const std::string summary = writeImage(job, image, out);
    std::cout << out.string() << ": " << summary << std::endl;  // seen at once
    return true;
  } catch (const DataError& error) {
    if (!std::string_view(error.what()).starts_with(image.string())) throw;  // it is the output's
    if (isWhole(image)) {
      spdlog::warn("{}", error.what());
    } else {
      images.putBack(image);  // the card was taken out
    }
    return false;
  }
}

}  // namespace

void watchImages(ImageJob job, const ImageWatch& watch) {
  constexpr milliseconds kForever = std::chrono::hours(24);
  const Existing existing = job.existing;
  CameraFolder images(watch.folder, watch.camera);
  if (watch.pass_over) images.passOver();
  std::set<fs::path> ours;
  std::size_t taken = 0;
  while (!watch.most || taken < *watch.most) {
    const auto image = images.next(watch.longest_idle.value_or(kForever));
    if (!image && watch.longest_idle) break;
    if (!image) continue;
    const fs::path out = outputOf(*image, watch);
    job.existing = ours.contains(out) ? Existing::replace : existing;  // the image has changed since
    if (!take(job, *image, out, images)) continue;
    ours.insert(out);
    ++taken;
  }
}

}  // namespace thermovox
