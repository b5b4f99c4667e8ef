#include "apps/simulate/truth.hpp"

#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "io/input_file.hpp"
#include "projection/error.hpp"
#include "projection/kind_names.hpp"

namespace thermovox::simulate {
namespace {

using Json = nlohmann::ordered_json;

Json vectorJson(const Eigen::Vector3d& v) {
  return Json::array({v.x(), v.y(), v.z()});
}

Eigen::Vector3d vectorFrom(const Json& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

Hall hallFrom(const Json& truth) {
  std::vector<Box> boxes;
  for (const Json& box : truth.at("boxes")) {
    boxes.push_back({vectorFrom(box.at(0)), vectorFrom(box.at(1)), box.at(2).get<double>()});
  }
  std::vector<Cylinder> cylinders;
  for (const Json& c : truth.at("cyls")) {
    const auto number = [&c](std::size_t i) { return c.at(i).get<double>(); };
    cylinders.push_back({number(0), number(1), number(2), number(3), number(4)});
  }
  std::vector<HotSpot> hot_spots;
  for (const Json& spot : truth.at("hotspots")) {
    const auto number = [&spot](const char* key) { return spot.at(key).get<double>(); };
    hot_spots.push_back({vectorFrom(spot.at("position")), number("delta"), number("sigma"), number("peak")});
  }
  return {vectorFrom(truth.at("size")), std::move(boxes), std::move(cylinders), std::move(hot_spots),
          truth.value("warmer", 0.0)};
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
  if (hall.warmer() != 0.0) truth["warmer"] = hall.warmer();
  truth["hotspots"] = Json::array();
  for (const HotSpot& spot : hall.hotSpots()) {
    truth["hotspots"].push_back({{"position", vectorJson(spot.position)},
                                 {"delta", spot.delta},
                                 {"sigma", spot.sigma},
                                 {"peak", spot.peak}});
  }
  truth["T_body_laser"] = poseJson(simulation.trueBodyLaser());
  const DrawnErrors& errors = simulation.drawnErrors();
  truth["pose_error"] = {{"rotation", vectorJson(errors.pose_rotation)},
                         {"translation", vectorJson(errors.pose_translation)}};
  truth["range_bias"] = errors.range_bias;
  truth["camera_bias"] = errors.camera_bias;
  return truth.dump(1) + "\n";
}

Hall readTrueHall(const std::filesystem::path& file) {
  const std::string text = readWhole(file);
  try {
    return hallFrom(Json::parse(text));
  } catch (const nlohmann::json::exception& error) {
    throw DataError(file.string() + ": " + error.what() + ", expected the truth of a simulated mission");
  }
}

}  // namespace thermovox::simulate
