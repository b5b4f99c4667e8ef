#include "apps/simulate/truth.hpp"

#include <nlohmann/json.hpp>

namespace thermovox::simulate {
namespace {

using Json = nlohmann::ordered_json;

Json vectorJson(const Eigen::Vector3d& v) {
  return Json::array({v.x(), v.y(), v.z()});
}

const char* nameOf(LaserKind kind) {
  switch (kind) {
    case LaserKind::beam:
      return "beam";
    case LaserKind::scan:
      return "scan";
    case LaserKind::cloud:
      break;
  }
  return "cloud";
}

Json poseJson(const Pose& pose) {
  const Eigen::Vector4d& q = pose.rotation.coeffs();
  return {{"translation", vectorJson(pose.translation)},
          {"quaternion_xyzw", Json::array({q.x(), q.y(), q.z(), q.w()})}};
}

}  // namespace

std::string truthText(const Simulation& simulation, std::size_t readings) {
  const Hall& hall = simulation.hall();
  Json truth;
  truth["laser"] = nameOf(simulation.options().laser);
  truth["seed"] = simulation.options().seed;
  truth["readings"] = readings;
  truth["duration"] = simulation.options().duration;
  truth["boxes"] = Json::array();
  for (const Box& box : hall.boxes()) {
    truth["boxes"].push_back(Json::array({vectorJson(box.low), vectorJson(box.high), box.celsius}));
  }
  truth["cyls"] = Json::array();
  for (const Cylinder& c : hall.cylinders()) {
    truth["cyls"].push_back(Json::array({c.x, c.y, c.radius, c.top, c.celsius}));
  }
  truth["size"] = vectorJson(hall.size());
  truth["hotspots"] = Json::array();
  for (const HotSpot& spot : hall.hotSpots()) {
    truth["hotspots"].push_back({{"position", vectorJson(spot.position)},
                                 {"delta", spot.delta},
                                 {"sigma", spot.sigma},
                                 {"peak", spot.peak}});
  }
  truth["T_body_laser"] = poseJson(simulation.trueBodyLaser());
  return truth.dump(1) + "\n";
}

}  // namespace thermovox::simulate
