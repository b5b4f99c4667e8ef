#include "io/flir_camera_info.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>

#include "io/byte_order.hpp"

namespace thermovox {
namespace {

/// Reads fields of the record, which begins with a number that is 2 in the right byte order, as all do.
class Fields {
 public:
  explicit Fields(std::span<const std::byte> bytes) : bytes_(bytes) {
    if (numberAt<std::uint16_t>(bytes, 0, ByteOrder::big) == 2) order_ = ByteOrder::big;
  }

  template <typename T>
  [[nodiscard]] std::optional<T> number(std::size_t offset) const {
    return numberAt<T>(bytes_, offset, order_);
  }
  /// A finite number; nullopt otherwise.
  [[nodiscard]] std::optional<double> real(std::size_t offset) const {
    const auto value = number<float>(offset);
    return value && std::isfinite(*value) ? std::optional<double>(*value) : std::nullopt;
  }
  /// Celsius of a temperature that can be.
  [[nodiscard]] std::optional<double> celsius(std::size_t offset) const {
    const auto kelvin = real(offset);
    constexpr double hottest = 1e4;  // beyond it a number is damaged
    if (!kelvin || !(*kelvin < hottest)) return std::nullopt;
    const double celsius = *kelvin + kAbsoluteZero;
    return celsius > kAbsoluteZero ? std::optional(celsius) : std::nullopt;
  }
  [[nodiscard]] std::string text(std::size_t offset, std::size_t length) const {
    return textAt(bytes_, offset, length);
  }

 private:
  std::span<const std::byte> bytes_;
  ByteOrder order_ = ByteOrder::little;
};

std::optional<PlanckConstants> planckOf(const Fields& fields) {
  const auto r1 = fields.real(0x58);
  const auto b = fields.real(0x5C);
  const auto f = fields.real(0x60);
  const auto o = fields.number<std::int32_t>(0x308);
  const auto r2 = fields.real(0x30C);
  if (!r1 || !b || !f || !o || !r2 || !(*r1 > 0.0) || !(*b > 0.0) || !(*r2 > 0.0)) return std::nullopt;
  return PlanckConstants{.r1 = *r1, .r2 = *r2, .b = *b, .f = *f, .o = static_cast<double>(*o)};
}

/// All zeros where a camera leaves them out: then the usual ones hold.
AtmosphereConstants atmosphereOf(const Fields& fields) {
  const auto alpha1 = fields.real(0x70);
  const auto alpha2 = fields.real(0x74);
  const auto beta1 = fields.real(0x78);
  const auto beta2 = fields.real(0x7C);
  const auto x = fields.real(0x80);
  if (!alpha1 || !alpha2 || !beta1 || !beta2 || !x) return {};
  if (*alpha1 == 0.0 && *alpha2 == 0.0 && *x == 0.0) return {};
  return {*alpha1, *alpha2, *beta1, *beta2, *x};
}

/// Of what lets through or radiates a part: 0 is not written on purpose.
double shareOf(std::optional<double> value, double usual) {
  constexpr double smallest = 0.05;
  return value && *value > 0.0 ? std::clamp(*value, smallest, 1.0) : usual;
}

/// A fraction; some cameras write percent.
double humidityOf(std::optional<double> value, double usual) {
  if (!value || *value < 0.0) return usual;
  return std::min(*value > 2.0 ? *value / 100.0 : *value, 1.0);
}

RadiometricParameters parametersOf(const Fields& fields, const PlanckConstants& planck) {
  RadiometricParameters usual;
  RadiometricParameters parameters;
  parameters.planck = planck;
  parameters.emissivity = shareOf(fields.real(0x20), usual.emissivity);
  const auto distance = fields.real(0x24);
  parameters.distance = distance && *distance >= 0.0 ? *distance : usual.distance;
  parameters.reflected = fields.celsius(0x28).value_or(usual.reflected);
  parameters.atmosphere_temperature = fields.celsius(0x2C).value_or(usual.atmosphere_temperature);
  parameters.window_temperature = fields.celsius(0x30).value_or(usual.window_temperature);
  parameters.window_transmission = shareOf(fields.real(0x34), usual.window_transmission);
  parameters.humidity = humidityOf(fields.real(0x3C), usual.humidity);
  parameters.atmosphere = atmosphereOf(fields);
  return parameters;
}

std::optional<CalibratedRange> calibratedRangeOf(const Fields& fields) {
  const auto high = fields.celsius(0x90);
  const auto low = fields.celsius(0x94);
  if (!high || !low || !(*low < *high)) return std::nullopt;
  return CalibratedRange{*low, *high};
}

/// Unix seconds, milliseconds, and the minutes that the camera's clock is behind universal time.
std::string timeOf(const Fields& fields) {
  const auto seconds = fields.number<std::uint32_t>(0x384);
  const auto milliseconds = fields.number<std::uint32_t>(0x388);
  const auto behind = fields.number<std::int16_t>(0x38C);
  if (!seconds || !milliseconds || !behind || *seconds == 0 || std::abs(*behind) > 24 * 60) return "";
  using namespace std::chrono;
  const sys_seconds local{std::chrono::seconds(std::int64_t{*seconds} - 60 * std::int64_t{*behind})};
  const year_month_day date{floor<days>(local)};
  const hh_mm_ss clock{local - floor<days>(local)};
  const int zone = std::abs(*behind);
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}.{:03}{}{:02}:{:02}", static_cast<int>(date.year()),
                     static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()),
                     clock.hours().count(), clock.minutes().count(), clock.seconds().count(),
                     (*milliseconds & 0xFFFF) % 1000, *behind > 0 ? '-' : '+', zone / 60, zone % 60);
}

}  // namespace

FlirCameraInfo parseFlirCameraInfo(std::span<const std::byte> bytes) {
  const Fields fields(bytes);
  FlirCameraInfo info;
  if (const auto planck = planckOf(fields)) info.parameters = parametersOf(fields, *planck);
  info.metadata.model = fields.text(0xD4, 32);
  info.metadata.serial = fields.text(0x104, 16);
  info.metadata.software = fields.text(0x114, 16);
  info.metadata.lens = fields.text(0x170, 32);
  const auto field_of_view = fields.real(0x1B4);
  if (field_of_view && *field_of_view > 0.0) info.metadata.field_of_view_deg = *field_of_view;
  info.metadata.calibrated_range = calibratedRangeOf(fields);
  info.metadata.time = timeOf(fields);
  return info;
}

}  // namespace thermovox
