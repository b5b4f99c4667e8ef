#pragma once

#include <functional>
#include <vector>

#include "tests/benchmark/engine.hpp"

namespace thermovox::bench {

/// Scans to insert, one after the other.
struct Workload {
  double resolution = 0.1;  ///< metres
  int scans = 0;
  std::function<std::vector<MappedReturn>(int index)> scan;
};

/// What it cost to insert a workload into a new map. Seconds are those of the insertions alone.
struct Measurement {
  double points = 0.0;
  double cpu_s = 0.0;          ///< processor time of all threads together
  double wall_s = 0.0;         ///< on a clock on the wall, whatever else the machine did
  double busier_half_s = 0.0;  ///< processor time of the calling thread or of all others, the larger: with
                               ///< two threads a bound for the wall time of a machine that does nothing else
  Engine::Cells cells;
  double memory_bytes = 0.0;  ///< the process's resident memory with the map, less that without it
  double peak_bytes = 0.0;    ///< its largest during the insertions, less that without the map
};

/// Measures in a process of its own, so that every engine starts with a fresh heap and its memory can be told
/// from that of others. Throws std::runtime_error when that process does not come to its end.
[[nodiscard]] Measurement measureInChild(const std::function<EnginePointer()>& make,
                                         const Workload& workload);

/// Gives every buffer as large as a scan pages of its own, which go when it goes: otherwise they leave holes
/// in the heap that would count as the map's. The heap itself keeps what it has, as it does by default.
void keepScansOutOfTheHeap();

/// Resident memory of this process, bytes.
[[nodiscard]] double residentBytes();

/// Adds up the time between start() and stop().
class Stopwatch {
 public:
  void start();
  void stop();
  [[nodiscard]] double cpu() const { return sum_.process; }
  [[nodiscard]] double wall() const { return sum_.wall; }
  [[nodiscard]] double busierHalf() const { return std::max(sum_.thread, sum_.process - sum_.thread); }

 private:
  struct Clocks {
    double wall = 0.0, process = 0.0, thread = 0.0;  ///< seconds
  };
  [[nodiscard]] static Clocks now();
  Clocks started_, sum_;
};

}  // namespace thermovox::bench
