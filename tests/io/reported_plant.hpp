#pragma once

#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "io/hotspot_report.hpp"
#include "mapping/hotspot_detection.hpp"

namespace thermovox::test {

/// A floor of 20 C, 8 x 6 m in cells of 5 cm, with spots 0.6 m apart that are warmer by `rise` C (in the
/// order of their place; none where a mission does not see the surroundings), as several missions saw it.
class ReportedPlant {
 public:
  using Rise = std::optional<double>;

  void fly(const std::string& name, const std::vector<Rise>& rises) {
    const ThermalMap own = floor(rises);
    map_.merge(own);
    StationHotspots& found = found_;
    found.layers.push_back(std::make_unique<SurfaceLayer>(own));
    found.history.add({name, found.layers.back().get(),
                       findHotspots(*found.layers.back(), HotspotCriteria{}, CameraSight{})});
    const auto flown =
        Time(std::chrono::seconds(1700000000 + 86400 * static_cast<int>(found.missions.size())));
    found.missions.push_back({.name = name,
                              .readings = 10,
                              .points = 19200,
                              .coloured = 19000,
                              .first = flown,
                              .last = flown + std::chrono::seconds(60),
                              .version = "0.1.0"});
  }

  [[nodiscard]] HotspotReport report(HotspotJudgement judgement = {}) const {
    return {.title = "Plant",
            .station = "plant.tvx",
            .version = "0.1.0",
            .criteria = {},
            .judgement = std::move(judgement),
            .found = found_,
            .map = map_};
  }

  [[nodiscard]] StationHotspots& found() { return found_; }

  /// Where spot i is, metres.
  [[nodiscard]] static Eigen::Vector3d placeOf(std::size_t i) {
    return Eigen::Vector3d(0.4 + 0.8 * static_cast<double>(i % 10), 0.6 + 1.2 * static_cast<double>(i / 10),
                           0.025);
  }

 private:
  static constexpr double kEdge = 0.05;

  static ThermalMap floor(const std::vector<Rise>& rises) {
    ThermalMap map({.resolution = kEdge});
    std::vector<MappedReturn> reading;
    for (int x = 0; x < 160; ++x) {
      for (int y = 0; y < 120; ++y) {
        const Eigen::Vector3d p((x + 0.5) * kEdge, (y + 0.5) * kEdge, 0.025);
        MappedReturn point{p, Eigen::Vector3d(4.0, 3.0, 3.0), Time(std::chrono::seconds(1700000000)),
                           std::nullopt};
        if (const Rise celsius = celsiusAt(p, rises)) {
          point.temperature = TemperatureObservation{static_cast<float>(*celsius), 0.1F, 3.0F, 0.1F};
        }
        reading.push_back(point);
      }
    }
    map.integrate(reading, Carving::none);
    return map;
  }

  static Rise celsiusAt(const Eigen::Vector3d& p, const std::vector<Rise>& rises) {
    double celsius = 20.0;
    for (std::size_t i = 0; i < rises.size(); ++i) {
      const double square = (p - placeOf(i)).squaredNorm();
      if (!rises[i] && square < 0.3 * 0.3) return std::nullopt;
      celsius += rises[i].value_or(0.0) * std::exp(-square / (2.0 * 0.1 * 0.1));
    }
    return celsius;
  }

  ThermalMap map_{ThermalMap::Options{.resolution = kEdge}};
  StationHotspots found_;
};

}  // namespace thermovox::test
