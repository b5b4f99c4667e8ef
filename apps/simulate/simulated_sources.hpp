#pragma once

#include <cstddef>
#include <optional>

#include "apps/simulate/simulation.hpp"
#include "apps/simulate/thermal_render.hpp"
#include "projection/sources.hpp"

namespace thermovox::simulate {

/// The mission as a reader of its files gets it, under a name of its own.
[[nodiscard]] Mission missionOf(const Simulation& simulation, const std::string& name);

/// The laser's readings of a simulation, without files. The simulation must outlive it.
class SimulatedReadings final : public ReadingSource {
 public:
  explicit SimulatedReadings(const Simulation& simulation) : simulation_(simulation) {}
  [[nodiscard]] std::optional<Reading> next() override;

 private:
  const Simulation& simulation_;
  std::size_t next_ = 0;
};

/// Its thermal frames, of temperatures (FrameFormat::tiff). The simulation must outlive it.
class SimulatedFrames final : public FrameSource {
 public:
  explicit SimulatedFrames(const Simulation& simulation) : simulation_(simulation), renderer_(simulation) {}
  [[nodiscard]] std::optional<ThermalFrame> next() override;
  [[nodiscard]] Duration period() const override;

 private:
  const Simulation& simulation_;
  ThermalRenderer renderer_;
  std::size_t next_ = 0;
};

/// One sweep as a reader of the files gets it.
[[nodiscard]] Reading readSweep(const Simulation& simulation, std::size_t sweep);

}  // namespace thermovox::simulate
