#pragma once

#include "tests/benchmark/measurement.hpp"

namespace thermovox::bench {

/// Every 25th scan of the hall, `scans` of them (at most 8): most points open a new cell.
[[nodiscard]] Workload coldHall(double resolution, int scans);
/// The first scans of the hall, one after the other: most points meet a cell that is there.
[[nodiscard]] Workload warmHall(double resolution, int scans);
/// A real scan of a building, each point given a temperature; no scans where the recordings are not there.
[[nodiscard]] Workload recordedBuilding(double resolution);

}  // namespace thermovox::bench
