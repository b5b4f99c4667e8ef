#include "io/point_rows.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <functional>
#include <queue>
#include <string>
#include <type_traits>
#include <utility>

#include "io/folders.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

static_assert(std::is_trivially_copyable_v<PointRow>);

constexpr std::size_t kChunk = 1024;  // rows read from a run, or handed out, at a time

void sortByStamp(std::vector<PointRow>& rows) {
  std::stable_sort(rows.begin(), rows.end(),
                   [](const PointRow& a, const PointRow& b) { return a.stamp < b.stamp; });
}

}  // namespace

/// A run in the file, read from its beginning.
class PointRows::Run {
 public:
  Run(const PointRows& owner, std::uint64_t begin, std::uint64_t end)
      : owner_(&owner), next_(begin), end_(end) {
    refill();
  }
  [[nodiscard]] bool done() const { return place_ == rows_.size(); }
  [[nodiscard]] const PointRow& head() const { return rows_[place_]; }
  void advance() {
    if (++place_ == rows_.size()) refill();
  }

 private:
  void refill() {
    rows_.resize(std::min<std::uint64_t>(kChunk, end_ - next_));
    place_ = 0;
    auto* bytes = reinterpret_cast<char*>(rows_.data());
    std::size_t left = rows_.size() * sizeof(PointRow);
    auto offset = static_cast<off_t>(next_ * sizeof(PointRow));
    while (left > 0) {
      const ssize_t got = ::pread(owner_->descriptor_, bytes, left, offset);
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) owner_->fail();
      bytes += got;
      offset += got;
      left -= static_cast<std::size_t>(got);
    }
    next_ += rows_.size();
  }

  const PointRows* owner_;
  std::uint64_t next_;
  std::uint64_t end_;
  std::vector<PointRow> rows_;
  std::size_t place_ = 0;
};

PointRows::PointRows(std::filesystem::path record, std::size_t rows_in_memory)
    : record_(std::move(record)), rows_in_memory_(rows_in_memory) {}

PointRows::~PointRows() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void PointRows::fail() const {
  throw DataError(record_.string() + ": cannot be written (" + std::strerror(errno) + ")");
}

void PointRows::add(const PointRow& row) {
  rows_.push_back(row);
  ++size_;
  if (rows_.size() >= rows_in_memory_) spill();
}

void PointRows::spill() {
  if (descriptor_ < 0) {
    descriptor_ = openUnnamedFile(folderOf(record_));
    if (descriptor_ < 0) fail();
  }
  sortByStamp(rows_);
  std::string_view bytes(reinterpret_cast<const char*>(rows_.data()), rows_.size() * sizeof(PointRow));
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail();
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  run_ends_.push_back(size_);
  rows_.clear();
}

void PointRows::writeSorted(const std::function<void(std::span<const PointRow>)>& write) {
  if (run_ends_.empty()) {
    sortByStamp(rows_);
    return write(rows_);
  }
  if (!rows_.empty()) spill();
  std::vector<Run> runs;
  for (std::size_t i = 0; i < run_ends_.size(); ++i) {
    runs.emplace_back(*this, i == 0 ? 0 : run_ends_[i - 1], run_ends_[i]);
  }
  using Head = std::pair<std::int64_t, std::size_t>;  // stamp, run: of equal stamps the earlier run's first
  std::priority_queue<Head, std::vector<Head>, std::greater<>> heads;
  for (std::size_t i = 0; i < runs.size(); ++i) heads.emplace(runs[i].head().stamp, i);
  while (!heads.empty()) {
    Run& run = runs[heads.top().second];
    rows_.push_back(run.head());
    run.advance();
    const std::size_t index = heads.top().second;
    heads.pop();
    if (!run.done()) heads.emplace(run.head().stamp, index);
    if (rows_.size() < kChunk && !heads.empty()) continue;
    write(rows_);
    rows_.clear();
  }
}

}  // namespace thermovox
