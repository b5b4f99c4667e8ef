#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <vector>

namespace thermovox {

/// One line of a points record, as plain bytes.
struct PointRow {
  std::int64_t stamp = 0;           ///< Unix nanoseconds
  std::array<double, 3> p_world{};  ///< metres
  double range = 0.0;               ///< the laser's own reading, metres
  std::array<double, 2> pixel{};    ///< u, v; here and below: only where it is coloured
  float celsius = 0.0F;
  float sigma = 0.0F;
  std::uint64_t coloured = 0;  ///< 0 or 1; as wide as the row's alignment, so that no byte is undefined
};

/// Rows in any order in, in the order of their stamps out, rows of one stamp as they came in. Up to
/// `rows_in_memory` are held in memory; more go to disk in sorted runs, which are merged at the end. The file
/// for them has no name, so nothing of it stays behind whatever happens.
class PointRows {
 public:
  static constexpr std::size_t kRowsInMemory = std::size_t{1} << 20;  // 72 MB

  /// `record` is the file the rows are for: the runs lie in its folder, and messages name it.
  explicit PointRows(std::filesystem::path record, std::size_t rows_in_memory = kRowsInMemory);
  ~PointRows();
  PointRows(const PointRows&) = delete;
  PointRows& operator=(const PointRows&) = delete;

  /// Throws DataError when the disk is full.
  void add(const PointRow& row);
  [[nodiscard]] std::uint64_t size() const { return size_; }
  /// Calls write with all rows, some at a time. To be called once, last.
  void writeSorted(const std::function<void(std::span<const PointRow>)>& write);

 private:
  class Run;
  void spill();
  [[noreturn]] void fail() const;

  std::filesystem::path record_;
  std::size_t rows_in_memory_;
  std::uint64_t size_ = 0;
  std::vector<PointRow> rows_;
  std::vector<std::uint64_t> run_ends_;  ///< of the runs in the file, in rows
  int descriptor_ = -1;
};

}  // namespace thermovox
