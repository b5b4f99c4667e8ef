#include "io/thermal_image_file.hpp"

#include <array>
#include <fstream>
#include <string>

#include "io/input_file.hpp"
#include "io/thermal_tiff.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

using namespace std::string_view_literals;

constexpr std::array kTiffMagics{"II*\0"sv, "MM\0*"sv, "II+\0"sv, "MM\0+"sv};

struct OtherKind {
  std::string_view magic;
  std::string_view name;
};
constexpr std::array kOtherKinds{
    OtherKind{"\xFF\xD8\xFF"sv, "a JPEG (radiometric ones are not read yet)"sv},
    OtherKind{"\x89PNG"sv, "a PNG picture"sv},
    OtherKind{"FFF\0"sv, "a FLIR recording (not read yet)"sv},
    OtherKind{"AFF\0"sv, "a FLIR recording (not read yet)"sv},
    OtherKind{"BM"sv, "a BMP picture"sv},
};

std::string beginningOf(const std::filesystem::path& file, std::string_view named_by) {
  std::ifstream stream = openInput(file, named_by);
  std::string beginning(8, '\0');
  stream.read(beginning.data(), static_cast<std::streamsize>(beginning.size()));
  beginning.resize(static_cast<std::size_t>(stream.gcount()));
  return beginning;
}

}  // namespace

ThermalImage readThermalImage(const std::filesystem::path& file, int page, const TLinear& t_linear,
                              std::string_view named_by) {
  const std::string beginning = beginningOf(file, named_by);
  for (const std::string_view magic : kTiffMagics) {
    if (beginning.starts_with(magic)) return readThermalTiff(file, page, t_linear);
  }
  for (const auto& [magic, name] : kOtherKinds) {
    if (beginning.starts_with(magic)) {
      throw DataError(file.string() + ": is " + std::string(name) +
                      ", expected a TIFF of 16-bit counts or 32-bit floats in Celsius");
    }
  }
  throw DataError(file.string() + ": " + (beginning.empty() ? "is empty" : "is no image of a known kind") +
                  ", expected a TIFF of 16-bit counts or 32-bit floats in Celsius");
}

}  // namespace thermovox
