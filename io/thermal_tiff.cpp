#include "io/thermal_tiff.hpp"

#include <utility>

#include "io/tiff_pages.hpp"
#include "io/tiff_scale.hpp"
#include "io/xmp.hpp"

namespace thermovox {
namespace {

/// What a page says; in a recording only the first one may say what camera it is.
TiffTags orElse(const TiffTags& own, const TiffTags& first) {
  const auto either = [](const std::string& a, const std::string& b) { return a.empty() ? b : a; };
  return {either(own.make, first.make),     either(own.model, first.model),
          either(own.serial, first.serial), either(own.software, first.software),
          either(own.time, first.time),     either(own.xmp, first.xmp)};
}

class ThermalTiff final : public ThermalRecording {
 public:
  template <typename Source>
  ThermalTiff(const Source& source, const std::string& name, const RecordingOptions& options)
      : pages_(source, name), t_linear_(options.t_linear), first_(pages_.tags()) {}

  int frames() const override { return pages_.count(); }

  RawThermalImage read(int frame) override {
    RawThermalImage image = pages_.read(frame);
    const TiffTags tags = orElse(pages_.tags(), first_);
    image.metadata.format = "TIFF";
    image.metadata.make = tags.make;
    image.metadata.model = tags.model;
    image.metadata.serial = tags.serial;
    image.metadata.software = tags.software;
    image.metadata.time = tags.time;
    image.metadata.xmp = xmpFacts(tags.xmp);
    if (image.counts.empty()) return image;
    ScaleDecision decision = decideScale(
        {.option = t_linear_, .xmp = tags.xmp, .make = tags.make, .model = tags.model}, image.counts);
    image.rule = std::move(decision.rule);
    image.rule_source = decision.source;
    return image;
  }

 private:
  TiffPages pages_;
  std::optional<TLinear> t_linear_;
  TiffTags first_;
};

}  // namespace

std::unique_ptr<ThermalRecording> openThermalTiff(const std::filesystem::path& file,
                                                  const RecordingOptions& options) {
  return std::make_unique<ThermalTiff>(file, file.string(), options);
}

std::unique_ptr<ThermalRecording> openThermalTiff(std::span<const std::byte> bytes, const std::string& name,
                                                  const RecordingOptions& options) {
  return std::make_unique<ThermalTiff>(bytes, name, options);
}

}  // namespace thermovox
