#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "apps/arguments.hpp"
#include "apps/radiometry_options.hpp"
#include "apps/verbs.hpp"
#include "io/celsius_decoder.hpp"
#include "io/rig_file.hpp"
#include "io/scale_warning.hpp"
#include "io/thermal_recording.hpp"
#include "mapping/blob_location.hpp"

namespace thermovox {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct LocateArgs {
  fs::path image;
  fs::path rig;
  double range = 0.0;
  double above = 0.0;
  std::string pose;
  std::vector<double> normal;
  int frame = 0;
  RadiometricOverrides overrides;
  ScaleArgs scale;
  bool json = false;
};

/// What is asked, read from the files.
struct Question {
  BeamShot shot;
  ThermalImage image;
  std::optional<Pose> T_world_body;
};

constexpr const char* kApproximation =
    "one distance stands for the whole frame: every blob is put onto the plane that the beam's hit spans, "
    "and "
    "no sigma says how far it lies before or behind it";

/// The rig's beam and thermal camera.
BeamShot shotOf(const LocateArgs& args, const Rig& rig) {
  const std::string file = args.rig.string();
  if (!rig.thermal_camera) throw ConfigError(file + ": has no thermal_camera, expected one");
  const auto isBeam = [](const Laser& laser) { return laser.kind == LaserKind::beam; };
  const auto beams = std::count_if(rig.lasers.begin(), rig.lasers.end(), isBeam);
  if (beams != 1) {
    throw ConfigError(fmt::format("{}: has {} lasers of kind beam, expected one that --range is of", file,
                                  beams == 0 ? "no" : std::to_string(beams)));
  }
  return {.beam = *std::find_if(rig.lasers.begin(), rig.lasers.end(), isBeam),
          .camera = *rig.thermal_camera,
          .range = args.range};
}

ThermalImage imageOf(const LocateArgs& args, const ThermalCamera& camera) {
  RecordingOptions options{.visible = VisibleInFrame::leave_out};
  const std::optional<TLinear> asked = args.scale.scale();
  options.t_linear = asked ? asked : camera.t_linear;
  const RawThermalImage raw = openThermalRecording(args.image, options)->read(args.frame);
  checkScale(asked, raw, args.image.string());
  if (const auto warning = scaleWarning(raw, args.image.string(), {"the rig", "--celsius-per-count"});
      warning && !asked) {
    spdlog::warn("{}", *warning);
  }
  RadiometricOverrides overrides = args.overrides;
  if (std::holds_alternative<RadiometricParameters>(raw.rule)) overrides.distance = args.range;
  return CelsiusDecoder().decode(raw, args.image.string(), overrides);
}

/// Of the surface, body frame.
std::optional<Eigen::Vector3d> normalOf(const LocateArgs& args, const std::optional<Pose>& T_world_body) {
  if (args.normal.empty()) return std::nullopt;
  const Eigen::Vector3d n(args.normal[0], args.normal[1], args.normal[2]);
  if (!n.allFinite() || !(n.norm() > 1e-9))
    throw UsageError("--normal: expected three numbers that are a direction");
  return T_world_body ? T_world_body->rotation.conjugate() * n.normalized() : n.normalized();
}

Question questionOf(const LocateArgs& args) {
  checkRadiometry(args.overrides);
  if (!(args.range > 0.0 && std::isfinite(args.range)))
    throw UsageError(fmt::format("--range: found {} m, expected a distance of more than 0 m", args.range));
  if (!std::isfinite(args.above)) throw UsageError("--above: expected a temperature in C");
  Question question{.shot = shotOf(args, readRig(args.rig))};
  if (!args.pose.empty()) question.T_world_body = poseFrom(args.pose, "--pose");
  question.shot.normal_body = normalOf(args, question.T_world_body);
  question.image = imageOf(args, question.shot.camera);
  return question;
}

Json jsonOf(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

Json jsonOf(const Eigen::Matrix3d& m) {
  return {jsonOf(Eigen::Vector3d(m.row(0))), jsonOf(Eigen::Vector3d(m.row(1))),
          jsonOf(Eigen::Vector3d(m.row(2)))};
}

/// A covariance along the axes of another frame; R_other_body.
Eigen::Matrix3d turned(const Eigen::Matrix3d& covariance, const Eigen::Matrix3d& R) {
  return R * covariance * R.transpose();
}

/// Null where there is no pose, or the blob is not on the plane.
Json placeJson(const Question& question, const std::optional<BlobPlace>& place) {
  Json json;
  for (const char* key :
       {"position_camera", "covariance_camera", "position_body", "covariance_body", "covariance_random_body",
        "covariance_common_body", "position", "covariance", "area"}) {
    json[key] = nullptr;
  }
  if (!place) return json;
  const Eigen::Matrix3d R_camera_body = question.shot.camera.T_body_camera.matrix().transpose();
  json["position_camera"] = jsonOf(place->p_camera);
  json["covariance_camera"] = jsonOf(turned(place->covariance(), R_camera_body));
  json["position_body"] = jsonOf(place->p_body);
  json["covariance_body"] = jsonOf(place->covariance());
  json["covariance_random_body"] = jsonOf(place->random);
  json["covariance_common_body"] = jsonOf(place->common);
  if (const auto& T_world_body = question.T_world_body) {
    json["position"] = jsonOf(*T_world_body * place->p_body);
    json["covariance"] = jsonOf(turned(place->covariance(), T_world_body->matrix()));
  }
  json["area"] = place->area;
  return json;
}

Json blobJson(const Question& question, const ThermalBlob& blob) {
  Json json{{"pixel", {blob.pixel.x(), blob.pixel.y()}},
            {"pixels", blob.pixels},
            {"peak", blob.peak.value},
            {"peak_sigma", std::hypot(blob.peak.sigma, blob.bias_sigma)},
            {"noise_sigma", blob.peak.sigma},
            {"bias_sigma", blob.bias_sigma},
            {"mean", blob.mean},
            {"reads_low", blob.reads_low}};
  json.update(placeJson(question, blob.place));
  return json;
}

void printJson(const LocateArgs& args, const Question& question, const std::vector<ThermalBlob>& blobs) {
  Json json{{"image", args.image.string()},
            {"approximation", kApproximation},
            {"range", args.range},
            {"above", args.above},
            {"plane",
             {{"point_body", jsonOf(question.shot.hitBody())},
              {"normal_body", jsonOf(question.shot.planeNormalBody())}}},
            {"pose", question.T_world_body ? Json("taken as exact") : Json(nullptr)},
            {"blobs", Json::array()}};
  for (const ThermalBlob& blob : blobs) json["blobs"].push_back(blobJson(question, blob));
  std::cout << json.dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
}

void printTable(const LocateArgs& args, const Question& question, const std::vector<ThermalBlob>& blobs) {
  if (blobs.empty()) {
    std::cout << fmt::format("nothing in {} is {} C or hotter\n", args.image.string(), args.above);
    return;
  }
  std::cout
      << fmt::format("approximation: {}\n", kApproximation)
      << "   peak C          mean C  pixels     cm2       u       v      x m      y m      z m   +- mm  ("
      << (question.T_world_body ? "world; the pose is taken as exact" : "body") << ")\n";
  for (const ThermalBlob& blob : blobs) {
    std::cout << fmt::format("{:8.1f}{} +-{:4.1f} {:7.1f} {:7}", blob.peak.value, blob.reads_low ? '<' : ' ',
                             std::hypot(blob.peak.sigma, blob.bias_sigma), blob.mean, blob.pixels);
    if (!blob.place) {
      std::cout << fmt::format(" {:>7} {:7.1f} {:7.1f}  not on the plane\n", "-", blob.pixel.x(),
                               blob.pixel.y());
      continue;
    }
    const Eigen::Vector3d p =
        question.T_world_body ? *question.T_world_body * blob.place->p_body : blob.place->p_body;
    std::cout << fmt::format(" {:7.1f} {:7.1f} {:7.1f} {:8.3f} {:8.3f} {:8.3f} {:7.1f}\n",
                             1e4 * blob.place->area, blob.pixel.x(), blob.pixel.y(), p.x(), p.y(), p.z(),
                             1e3 * std::sqrt(blob.place->covariance().trace()));
  }
}

void runLocate(const LocateArgs& args) {
  const Question question = questionOf(args);
  std::vector<ThermalBlob> blobs;
  try {
    blobs = locateBlobs(question.image, args.above, question.shot);
  } catch (const DataError& error) {
    throw DataError(args.image.string() + ": " + error.what());
  }
  if (args.json) {
    printJson(args, question, blobs);
  } else {
    printTable(args, question, blobs);
  }
}

}  // namespace

void addLocate(CLI::App& app) {
  auto args = std::make_shared<LocateArgs>();
  CLI::App* verb = app.add_subcommand(
      "locate",
      "Locate what is hot in one thermal frame by one reading of a beam: an approximation, since the beam's "
      "distance stands for all that the frame shows. The hottest first; '<' marks what reads low (under 3 x "
      "3 "
      "pixels). For places with one distance each, map a mission and ask 'hotspots'.");
  verb->add_option("IMAGE", args->image, "Thermal image, as for 'image'")->required();
  verb->add_option("--range", args->range, "The beam's reading [m]")->required();
  verb->add_option("--rig", args->rig, "Rig (.yaml) with a thermal camera and a laser of kind beam")
      ->required();
  verb->add_option("--above", args->above, "What is hot: temperatures from this on [C]")->required();
  verb->add_option(
      "--pose", args->pose,
      "T_world_body when the frame was taken, \"tx ty tz qx qy qz qw\" [m, unit quaternion], or a "
      "file that holds it; taken as exact. Without it places are in the body's frame");
  verb->add_option("--normal", args->normal,
                   "Direction across the surface, X Y Z, in the world with --pose, else in the body "
                   "(default: along the beam)")
      ->expected(3);
  verb->add_option("--frame", args->frame, "Frame of a recording, page of a TIFF, from 0")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  addRadiometryOptions(*verb, args->overrides);
  addScaleOptions(*verb, args->scale,
                  "what the rig says, else the file, else its camera's, else by the range of the counts");
  verb->add_flag("--json", args->json, "Print one JSON object");
  verb->callback([args] { runLocate(*args); });
}

}  // namespace thermovox
