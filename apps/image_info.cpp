#include "apps/image_info.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <variant>

#include "apps/radiometry_options.hpp"
#include "io/celsius_decoder.hpp"
#include "io/thermal_recording.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

using Json = nlohmann::ordered_json;

/// To a ten-thousandth; null for NaN. A 32-bit float tells no more.
Json rounded(double celsius) {
  return std::isfinite(celsius) ? Json(std::round(celsius * 1e4) / 1e4) : Json();
}

void putText(Json& json, const char* key, const std::string& text) {
  if (!text.empty()) json[key] = text;
}

Json cameraOf(const ThermalMetadata& metadata) {
  Json json = Json::object();
  putText(json, "make", metadata.make);
  putText(json, "model", metadata.model);
  putText(json, "serial", metadata.serial);
  putText(json, "lens", metadata.lens);
  putText(json, "software", metadata.software);
  if (metadata.field_of_view_deg) json["field_of_view_deg"] = rounded(*metadata.field_of_view_deg);
  if (const auto& range = metadata.calibrated_range)
    json["calibrated_range"] = {rounded(range->low), rounded(range->high)};
  if (metadata.xmp.focal_length_mm) json["focal_length_mm"] = *metadata.xmp.focal_length_mm;
  if (!metadata.xmp.principal_point_mm.empty()) json["principal_point_mm"] = metadata.xmp.principal_point_mm;
  if (!metadata.xmp.perspective_distortion.empty())
    json["perspective_distortion"] = metadata.xmp.perspective_distortion;
  return json;
}

Json parametersOf(const RadiometricParameters& p) {
  return {
      {"emissivity", rounded(p.emissivity)},
      {"distance", rounded(p.distance)},
      {"reflected", rounded(p.reflected)},
      {"atmosphere_temperature", rounded(p.atmosphere_temperature)},
      {"humidity", rounded(p.humidity)},
      {"window_temperature", rounded(p.window_temperature)},
      {"window_transmission", rounded(p.window_transmission)},
      {"planck",
       {{"r1", p.planck.r1}, {"b", p.planck.b}, {"f", p.planck.f}, {"o", p.planck.o}, {"r2", p.planck.r2}}},
      {"atmosphere",
       {{"alpha1", p.atmosphere.alpha1},
        {"alpha2", p.atmosphere.alpha2},
        {"beta1", p.atmosphere.beta1},
        {"beta2", p.atmosphere.beta2},
        {"x", p.atmosphere.x}}}};
}

Json scaleOf(const TLinear& t_linear, RuleSource source) {
  const char* from = source == RuleSource::option  ? "the user"
                     : source == RuleSource::file  ? "the file"
                     : source == RuleSource::model ? "the camera's model"
                                                   : "the range of the counts";
  return {{"celsius_per_count", t_linear.celsius_per_count},
          {"celsius_offset", t_linear.celsius_offset},
          {"from", from}};
}

Json countsOf(const std::vector<std::uint16_t>& counts) {
  const auto [low, high] = std::minmax_element(counts.begin(), counts.end());
  const double sum = std::accumulate(counts.begin(), counts.end(), 0.0);
  return {{"min", *low}, {"mean", rounded(sum / static_cast<double>(counts.size()))}, {"max", *high}};
}

/// The corners and the middle; `celsius` may be empty.
Json pixelsOf(const RawThermalImage& image, const std::vector<float>& celsius) {
  struct Place {
    const char* name;
    int u, v;
  };
  const int right = image.width - 1;
  const int bottom = image.height - 1;
  Json json = Json::object();
  for (const auto& [name, u, v] : {Place{"top_left", 0, 0}, Place{"top_right", right, 0},
                                   Place{"centre", image.width / 2, image.height / 2},
                                   Place{"bottom_left", 0, bottom}, Place{"bottom_right", right, bottom}}) {
    const auto i =
        static_cast<std::size_t>(v) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(u);
    Json pixel{{"xy", {u, v}}};
    if (!image.counts.empty()) pixel["counts"] = image.counts[i];
    if (!celsius.empty()) pixel["celsius"] = rounded(celsius[i]);
    json[name] = std::move(pixel);
  }
  return json;
}

/// Throws DataError where what the user knows is of another kind of image.
void checkKnowledge(const ImageKnowledge& knowledge, const RawThermalImage& image, const std::string& name) {
  if (std::holds_alternative<NotTemperature>(image.rule)) return;
  if (knowledge.radiometry.any() && !std::holds_alternative<RadiometricParameters>(image.rule)) {
    throw DataError(
        name +
        ": has no radiometric parameters of its own, expected a FLIR file where one of them is to "
        "be replaced");
  }
  checkScale(knowledge.t_linear, image, name);
}

void putTemperatures(Json& json, const RawThermalImage& image, const std::string& name,
                     const RadiometricOverrides& overrides) {
  const ThermalImage decoded = CelsiusDecoder().decode(image, name, overrides);
  const ThermalStatistics statistics = statisticsOf(decoded, image.metadata.calibrated_range);
  if (statistics.mean) {
    json["min"] = rounded(*statistics.min);
    json["mean"] = rounded(*statistics.mean);
    json["max"] = rounded(*statistics.max);
  }
  json["unknown_pixels"] = statistics.unknown;
  if (image.metadata.calibrated_range) {
    json["below_range"] = statistics.below_range;
    json["above_range"] = statistics.above_range;
  }
  json["pixels"] = pixelsOf(image, decoded.celsius);
}

void putRule(Json& json, const RawThermalImage& image, const RadiometricOverrides& overrides) {
  if (const auto* parameters = std::get_if<RadiometricParameters>(&image.rule)) {
    json["parameters"] = parametersOf(overrides.applyTo(*parameters));
  } else if (const auto* t_linear = std::get_if<TLinear>(&image.rule)) {
    json["scale"] = scaleOf(*t_linear, image.rule_source);
    if (image.rule_source == RuleSource::counts) {
      json["note"] =
          "the scale is a guess by the range of the counts; --celsius-per-count says another, and in a "
          "mission "
          "celsius_per_count of the rig";
    }
  }
}

void putVisible(Json& json, const ThermalMetadata& metadata) {
  if (const auto& visible = metadata.visible) {
    json["visible"] = {{"width", visible->width},
                       {"height", visible->height},
                       {"encoding", visible->encoding == EmbeddedPicture::Encoding::png ? "png" : "jpeg"}};
  }
  if (const auto& pip = metadata.picture_in_picture) {
    json["picture_in_picture"] = {{"real_to_ir", pip->real_to_ir},
                                  {"offset_px", {pip->offset_x, pip->offset_y}}};
  }
}

/// The first frame, and how many there are.
struct FirstFrame {
  RawThermalImage image;
  int frames = 0;
};

FirstFrame firstFrameOf(const std::filesystem::path& file, const ImageKnowledge& knowledge) {
  RecordingOptions options;
  options.t_linear = knowledge.t_linear;
  const auto recording = openThermalRecording(file, options);
  return {recording->read(0), recording->frames()};
}

void describe(Json& json, const FirstFrame& first, const std::filesystem::path& file,
              const RadiometricOverrides& overrides) {
  const RawThermalImage& image = first.image;
  const auto* none = std::get_if<NotTemperature>(&image.rule);
  json["radiometric"] = none == nullptr;
  if (none != nullptr) json["reason"] = file.string() + ": " + none->reason;
  json["format"] = image.metadata.format;
  json["width"] = image.width;
  json["height"] = image.height;
  json["frames"] = first.frames;
  json["camera"] = cameraOf(image.metadata);
  putText(json, "time", image.metadata.time);
  putRule(json, image, overrides);
  if (!image.counts.empty()) json["counts"] = countsOf(image.counts);
  if (none == nullptr) {
    putTemperatures(json, image, file.string(), overrides);
  } else {
    json["pixels"] = pixelsOf(image, {});
  }
  putVisible(json, image.metadata);
}

}  // namespace

Json imageInfo(const std::filesystem::path& file, const ImageKnowledge& knowledge) {
  Json json{{"kind", "image"}};
  std::optional<FirstFrame> first;
  const auto answer = [&json](const auto& step) {
    try {
      step();
    } catch (const Error& error) {  // damaged, or of a kind without temperatures: that too is an answer
      json["radiometric"] = false;
      json["reason"] = error.what();
    }
  };
  answer([&] { first = firstFrameOf(file, knowledge); });
  if (!first) return json;
  if (knowledge.any()) checkKnowledge(knowledge, first->image, file.string());
  answer([&] { describe(json, *first, file, knowledge.radiometry); });
  return json;
}

}  // namespace thermovox
