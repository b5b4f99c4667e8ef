#include "io/camera_folder.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <string_view>
#include <system_error>
#include <utility>

namespace thermovox {
namespace fs = std::filesystem;
namespace {

using std::chrono::milliseconds;

bool isHidden(const fs::path& path) {
  return path.filename().native().starts_with('.');
}

bool isImage(const fs::path& file) {
  constexpr std::array<std::string_view, 7> endings{".jpg", ".jpeg", ".tif", ".tiff", ".seq", ".csq", ".fff"};
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::find(endings.begin(), endings.end(), ending) != endings.end();
}

/// FNV-1a, 64 bits (Fowler, Noll, Vo), of a file's content: of all of it up to 128 KiB, of larger files of 16
/// pieces from the first bytes to the last. So a card that is back is known by little reading, and an image
/// that another one has replaced differs somewhere in them, even at the same size. nullopt when the file
/// cannot be read.
std::optional<std::uint64_t> digestOf(const fs::path& file, std::uintmax_t size) {
  constexpr std::uintmax_t pieces = 16;
  std::array<char, 8192> buffer;
  const std::uintmax_t beyond = size > pieces * buffer.size() ? size - buffer.size() : 0;
  std::ifstream stream(file, std::ios::binary);
  std::uint64_t digest = 0xcbf29ce484222325U;
  for (std::uintmax_t i = 0; i < pieces && stream; ++i) {
    if (beyond > 0) stream.seekg(static_cast<std::streamoff>(beyond * i / (pieces - 1)));
    stream.read(buffer.data(), buffer.size());
    for (std::streamsize k = 0; k < stream.gcount(); ++k) {
      digest ^= static_cast<unsigned char>(buffer[static_cast<std::size_t>(k)]);
      digest *= 0x100000001b3U;
    }
  }
  if (stream.bad() || !stream.is_open() || (beyond > 0 && !stream)) return std::nullopt;
  return digest;
}

}  // namespace

CameraFolder::CameraFolder(fs::path folder, const Options& options)
    : folder_(std::move(folder)), options_(options), events_(options.events) {}

std::optional<fs::path> CameraFolder::next(milliseconds longest) {
  const Clock::time_point end = Clock::now() + longest;
  FolderEvents::Changes changes = events_.wait(milliseconds(0));  // since the last call
  for (;;) {
    look(changes);
    for (auto image = nextReady(); image != waiting_.end(); image = nextReady()) {
      const auto [name, waiting] = *image;
      waiting_.erase(image);
      if (give(name, waiting.state)) return folder_ / name;
    }
    if (Clock::now() >= end) return std::nullopt;
    changes = hear(std::min(end, Clock::now() + options_.look_every));
  }
}

void CameraFolder::passOver() {
  lookThroughAll({});
  for (const auto& [name, waiting] : std::exchange(waiting_, {})) give(name, waiting.state);
}

void CameraFolder::putBack(const fs::path& image) {
  given_.erase(nameOf(image));
}

FolderEvents::Changes CameraFolder::hear(Clock::time_point end) {
  FolderEvents::Changes heard;
  for (;;) {
    const auto left = std::chrono::ceil<milliseconds>(end - Clock::now());
    const FolderEvents::Changes news = events_.wait(std::max(left, milliseconds(0)));
    bool whole = false;
    for (const auto& [file, change] : news) {
      heard[file] = change;
      whole = whole || change == FolderEvents::Change::written;
    }
    // A camera that writes a long recording says so thousands of times: nothing is to be done before its end.
    if (whole || news.empty() || Clock::now() >= end) return heard;
  }
}

void CameraFolder::look(const FolderEvents::Changes& changes) {
  const bool known = !changes.empty() || nextReady() != waiting_.end();
  if (!known || Clock::now() - looked_through_ >= options_.look_every) {
    lookThroughAll(changes);
    return;
  }
  looked_ = Clock::now();
  for (const auto& [file, change] : changes) {
    if (isHidden(file) || !isImage(file)) continue;
    WaitingImages seen;
    lookAt(file, changes, seen);
    waiting_.erase(nameOf(file));
    waiting_.merge(seen);
  }
}

void CameraFolder::lookThroughAll(const FolderEvents::Changes& changes) {
  WaitingImages still_there;
  std::error_code error;
  looked_ = looked_through_ = Clock::now();
  events_.watch(folder_);
  for (fs::recursive_directory_iterator entry(folder_, fs::directory_options::skip_permission_denied, error);
       !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    std::error_code unknown;
    if (isHidden(entry->path())) {
      entry.disable_recursion_pending();
    } else if (entry->is_directory(unknown)) {
      events_.watch(entry->path());
    } else if (isImage(entry->path())) {
      lookAt(entry->path(), changes, still_there);
    }
  }
  waiting_ = std::move(still_there);
}

void CameraFolder::lookAt(const fs::path& file, const FolderEvents::Changes& changes,
                          WaitingImages& still_there) {
  const std::optional<State> state = stateOf(file);
  if (!state) return;
  const std::string name = nameOf(file);
  const auto given = given_.find(name);
  if (given != given_.end() && given->second.state == *state) return;
  const auto before = waiting_.find(name);
  const bool is_still = before != waiting_.end() && before->second.state == *state;
  const bool was_open = before != waiting_.end() && before->second.heard == FolderEvents::Change::touched;
  Waiting waiting{*state, looked_, was_open ? std::optional(FolderEvents::Change::touched) : std::nullopt};
  if (is_still) waiting = before->second;
  if (const auto change = changes.find(file); change != changes.end()) {
    waiting.heard = change->second;
    if (waiting.heard == FolderEvents::Change::touched) waiting.since = looked_;
  }
  still_there.emplace(name, waiting);
}

std::optional<CameraFolder::State> CameraFolder::stateOf(const fs::path& file) {
  std::error_code unknown;
  if (!fs::is_regular_file(file, unknown)) return std::nullopt;
  State state;
  state.size = fs::file_size(file, unknown);
  if (unknown || state.size == 0) return std::nullopt;
  state.changed = fs::last_write_time(file, unknown);
  return unknown ? std::nullopt : std::optional(state);
}

std::string CameraFolder::nameOf(const fs::path& file) const {
  return file.lexically_relative(folder_).string();
}

bool CameraFolder::isReady(const Waiting& image) const {
  if (image.heard == FolderEvents::Change::written) return true;
  const bool open = image.heard == FolderEvents::Change::touched;
  return looked_ - image.since >=
         (open ? std::max(options_.settled, options_.settled_open) : options_.settled);
}

CameraFolder::WaitingImages::iterator CameraFolder::nextReady() {
  auto best = waiting_.end();
  for (auto image = waiting_.begin(); image != waiting_.end(); ++image) {
    if (!isReady(image->second)) continue;
    if (best == waiting_.end()) {
      best = image;
      continue;
    }
    // Memory cards count time in steps of two seconds: of equal times the names, which count up, decide.
    const auto age = [](const auto& one) { return std::pair(one->second.state.changed, one->first); };
    const bool newest_first = options_.order == Order::newest_first;
    if (newest_first ? age(best) < age(image) : age(image) < age(best)) best = image;
  }
  return best;
}

bool CameraFolder::give(const std::string& name, const State& state) {
  const fs::path file = folder_ / name;
  const std::optional<std::uint64_t> digest = digestOf(file, state.size);
  // Gone again, or being written again: it is looked at anew.
  if (!digest || stateOf(file) != state) return false;
  Given& given = given_[name];
  const bool is_new = given.state.size != state.size || given.digest != *digest;
  given = {state, *digest};
  return is_new;
}

}  // namespace thermovox
