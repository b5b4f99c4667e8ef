#include "io/asset_file.hpp"

#include <cmath>
#include <numbers>
#include <utility>

#include "io/input_file.hpp"
#include "io/number_text.hpp"
#include "io/unit_quaternion.hpp"
#include "io/yaml_map.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

constexpr std::size_t kLargestAssetFile = std::size_t{1} << 24;  // bytes; some 200 an asset

/// Text for reports.
std::string printable(const YamlMap& map, std::string_view key) {
  std::string text = map.text(key);
  if (!isPrintableUtf8(text)) {
    throw ConfigError(map.place(key) + ": found " + inQuotes(text) + ", expected printable UTF-8");
  }
  return text;
}

Eigen::Vector3d vector(const YamlMap& map, std::string_view key) {
  const std::vector<double> numbers = map.numbers(key, 3);
  return {numbers[0], numbers[1], numbers[2]};
}

void refuseBeside(const YamlMap& map, std::initializer_list<std::string_view> keys, const char* other) {
  for (const std::string_view key : keys) {
    if (map.has(key)) {
      throw ConfigError(map.place(key) + ": is given beside " + other + ", expected one or the other");
    }
  }
}

/// The box by two corners of the world, perhaps turned.
void readCorners(const YamlMap& map, Asset& asset) {
  const Eigen::Vector3d min = vector(map, "min"), max = vector(map, "max");
  for (int axis = 0; axis < 3; ++axis) {
    if (max[axis] > min[axis]) continue;
    throw ConfigError(map.place("max") + ": has " + exactText(max[axis]) + " where min has " +
                      exactText(min[axis]) + ", expected more on every axis");
  }
  asset.size = max - min;
  asset.T_world_box.translation = min + asset.size / 2.0;
  const double half_yaw = map.numberIf("yaw_deg").value_or(0.0) * std::numbers::pi / 360.0;
  asset.T_world_box.rotation = {std::cos(half_yaw), 0.0, 0.0, std::sin(half_yaw)};
}

void readPosed(const YamlMap& map, Asset& asset) {
  const YamlMap pose = map.map("pose");
  pose.allow({"translation", "quaternion_xyzw"});
  const std::vector<double> q = pose.numbers("quaternion_xyzw", 4);
  const std::optional<Eigen::Quaterniond> rotation = unitQuaternion(q[0], q[1], q[2], q[3]);
  if (!rotation) {
    throw ConfigError(pose.place("quaternion_xyzw") + ": " + quaternionFault(q[0], q[1], q[2], q[3]));
  }
  asset.T_world_box = {*rotation, vector(pose, "translation")};
  asset.size = vector(map, "size");
}

Asset readAsset(const YamlMap& map) {
  map.allow({"name", "min", "max", "yaw_deg", "pose", "size", "emissivity", "limits", "twin_group"});
  Asset asset{.name = printable(map, "name")};
  if (map.has("pose")) {
    refuseBeside(map, {"min", "max", "yaw_deg"}, "pose");
    readPosed(map, asset);
  } else {
    refuseBeside(map, {"size"}, "min and max");
    readCorners(map, asset);
  }
  asset.emissivity = map.numberIf("emissivity");
  if (const std::optional<YamlMap> limits = map.mapIf("limits")) {
    limits->allow({"above", "delta"});
    asset.limits = {limits->numberIf("above"), limits->numberIf("delta")};
  }
  if (map.has("twin_group")) asset.twin_group = printable(map, "twin_group");
  return asset;
}

}  // namespace

Assets parseAssets(const std::string& text, const std::string& name) {
  const YamlMap map = YamlMap::parse(text, name);
  map.allow({"assets"});
  std::vector<Asset> assets;
  for (const YamlMap& entry : map.mapOrList("assets")) assets.push_back(readAsset(entry));
  if (assets.empty()) throw ConfigError(map.place("assets") + ": names none, expected one at least");
  try {
    return Assets(std::move(assets));
  } catch (const ConfigError& error) {
    throw ConfigError(name + ", " + error.what());
  }
}

Assets readAssets(const std::filesystem::path& file) {
  return parseAssets(readWhole(file, "", kLargestAssetFile), file.string());
}

}  // namespace thermovox
