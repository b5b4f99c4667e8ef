#include "io/thermal_tiff.hpp"

#include <tiffio.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <limits>
#include <memory>
#include <system_error>
#include <utility>
#include <vector>

#include "io/input_file.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

constexpr std::uint64_t kMostPixels = 100'000'000;
/// No codec packs pixels tighter than about this, so a small file that claims a large image is damaged.
constexpr std::uint64_t kTightestPacking = 10'000;
constexpr tmsize_t kLargestAllocation = tmsize_t{1} << 30;

/// A TIFF held in memory, as libtiff's callbacks want it.
struct MemoryFile {
  std::span<const std::byte> bytes;
  std::uint64_t position = 0;
};

tmsize_t readMemory(thandle_t handle, void* target, tmsize_t size) {
  auto& file = *static_cast<MemoryFile*>(handle);
  const std::uint64_t left = file.position < file.bytes.size() ? file.bytes.size() - file.position : 0;
  const std::uint64_t count =
      std::min<std::uint64_t>(left, static_cast<std::uint64_t>(std::max<tmsize_t>(size, 0)));
  if (count > 0) std::memcpy(target, file.bytes.data() + file.position, count);
  file.position += count;
  return static_cast<tmsize_t>(count);
}

tmsize_t writeNothing(thandle_t, void*, tmsize_t) {
  return -1;
}

toff_t seekMemory(thandle_t handle, toff_t offset, int whence) {
  auto& file = *static_cast<MemoryFile*>(handle);
  const std::uint64_t base = whence == SEEK_CUR ? file.position : whence == SEEK_END ? file.bytes.size() : 0;
  return file.position = base + offset;
}

int closeNothing(thandle_t) {
  return 0;
}

toff_t sizeOfMemory(thandle_t handle) {
  return static_cast<MemoryFile*>(handle)->bytes.size();
}

/// libtiff's first complaint; the later ones follow from it.
struct Complaint {
  std::string text;
};

int keepComplaint(TIFF*, void* complaint, const char*, const char* format, va_list arguments) {
  std::array<char, 256> text{};
  std::vsnprintf(text.data(), text.size(), format, arguments);
  auto& first = static_cast<Complaint*>(complaint)->text;
  if (first.empty()) first = text.data();
  return 1;  // handled: nothing reaches libtiff's global handlers, which print
}

int passOver(TIFF*, void*, const char*, const char*, va_list) {
  return 1;  // unknown tags and the like
}

struct CloseTiff {
  void operator()(TIFF* tiff) const { TIFFClose(tiff); }
};
struct FreeOptions {
  void operator()(TIFFOpenOptions* options) const { TIFFOpenOptionsFree(options); }
};

/// What the current page holds.
struct Layout {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint16_t bits = 1;
  bool floating = false;
  [[nodiscard]] std::size_t sampleSize() const { return bits / 8; }
};

/// An open TIFF whose complaints become DataErrors and are never printed.
class TiffFile {
 public:
  explicit TiffFile(const std::filesystem::path& path) : name_(path.string()) {
    static_cast<void>(openInput(path));  // says why a file cannot be read
    std::error_code no_size;
    size_ = std::filesystem::file_size(path, no_size);
    if (no_size) fail("is no regular file");
    tiff_.reset(TIFFOpenExt(path.c_str(), "r", options().get()));
    if (!tiff_) fail("is not a readable TIFF");
  }
  TiffFile(std::span<const std::byte> bytes, std::string name)
      : name_(std::move(name)), memory_{bytes}, size_(bytes.size()) {
    tiff_.reset(TIFFClientOpenExt(name_.c_str(), "rm", &memory_, readMemory, writeNothing, seekMemory,
                                  closeNothing, sizeOfMemory, nullptr, nullptr, options().get()));
    if (!tiff_) fail("is not a readable TIFF");
  }
  TiffFile(const TiffFile&) = delete;
  TiffFile& operator=(const TiffFile&) = delete;

  [[nodiscard]] int pages() { return static_cast<int>(TIFFNumberOfDirectories(tiff_.get())); }
  [[nodiscard]] ThermalPixels pixels() {
    return layout().floating ? ThermalPixels::celsius : ThermalPixels::counts;
  }
  ThermalImage read(int page, const TLinear& t_linear);

 private:
  [[nodiscard]] std::unique_ptr<TIFFOpenOptions, FreeOptions> options();
  [[nodiscard]] Layout layout();
  void goTo(int page);
  void readStrips(const Layout& layout, std::vector<std::byte>& pixels);
  void readTiles(const Layout& layout, std::vector<std::byte>& pixels);
  [[noreturn]] void fail(const std::string& what) const;

  std::string name_;
  MemoryFile memory_;
  std::uint64_t size_ = 0;  // bytes of the file
  Complaint complaint_;
  std::unique_ptr<TIFF, CloseTiff> tiff_;
};

std::unique_ptr<TIFFOpenOptions, FreeOptions> TiffFile::options() {
  std::unique_ptr<TIFFOpenOptions, FreeOptions> options(TIFFOpenOptionsAlloc());
  TIFFOpenOptionsSetMaxSingleMemAlloc(options.get(), kLargestAllocation);
  TIFFOpenOptionsSetErrorHandlerExtR(options.get(), keepComplaint, &complaint_);
  TIFFOpenOptionsSetWarningHandlerExtR(options.get(), passOver, nullptr);
  return options;
}

void TiffFile::fail(const std::string& what) const {
  throw DataError(name_ + ": " + what + (complaint_.text.empty() ? "" : " (" + complaint_.text + ")"));
}

void TiffFile::goTo(int page) {
  if (page == 0) return;  // open stands there
  if (page < 0 || TIFFSetDirectory(tiff_.get(), static_cast<tdir_t>(page)) == 0) {
    const int count = pages();
    if (page >= 0 && page < count) fail("page " + std::to_string(page) + " cannot be read");
    fail("has no page " + std::to_string(page) + ", expected 0 to " + std::to_string(count - 1));
  }
}

Layout TiffFile::layout() {
  Layout layout;
  std::uint16_t samples = 1;
  std::uint16_t format = SAMPLEFORMAT_UINT;
  TIFFGetField(tiff_.get(), TIFFTAG_IMAGEWIDTH, &layout.width);
  TIFFGetField(tiff_.get(), TIFFTAG_IMAGELENGTH, &layout.height);
  TIFFGetFieldDefaulted(tiff_.get(), TIFFTAG_BITSPERSAMPLE, &layout.bits);
  TIFFGetFieldDefaulted(tiff_.get(), TIFFTAG_SAMPLESPERPIXEL, &samples);
  TIFFGetFieldDefaulted(tiff_.get(), TIFFTAG_SAMPLEFORMAT, &format);
  layout.floating = format == SAMPLEFORMAT_IEEEFP;
  const bool counts = layout.bits == 16 && (format == SAMPLEFORMAT_UINT || format == SAMPLEFORMAT_VOID);
  if (samples != 1 || !(counts || (layout.floating && layout.bits == 32))) {
    fail("has " + std::to_string(samples) + " sample(s) of " + std::to_string(layout.bits) + " bits" +
         (format == SAMPLEFORMAT_INT ? " with sign" : "") +
         " a pixel, expected one of 16 bits (counts) or a 32-bit float (Celsius)");
  }
  const std::uint64_t pixels = std::uint64_t{layout.width} * layout.height;
  if (pixels == 0 || pixels > kMostPixels || pixels * layout.sampleSize() / kTightestPacking > size_) {
    fail("claims " + std::to_string(layout.width) + " x " + std::to_string(layout.height) + " pixels in " +
         std::to_string(size_) + " bytes, expected a thermal image");
  }
  return layout;
}

void TiffFile::readStrips(const Layout& layout, std::vector<std::byte>& pixels) {
  std::uint32_t rows_per_strip = layout.height;
  TIFFGetFieldDefaulted(tiff_.get(), TIFFTAG_ROWSPERSTRIP, &rows_per_strip);
  const std::size_t row_size = layout.width * layout.sampleSize();
  const std::uint64_t rows = std::clamp<std::uint64_t>(rows_per_strip, 1, layout.height);
  std::uint32_t strip = 0;
  for (std::uint64_t first = 0; first < layout.height; first += rows, ++strip) {
    const auto wanted =
        static_cast<tmsize_t>(std::min<std::uint64_t>(rows, layout.height - first) * row_size);
    if (TIFFReadEncodedStrip(tiff_.get(), strip, pixels.data() + first * row_size, wanted) != wanted) {
      fail("is truncated or damaged in strip " + std::to_string(strip));
    }
  }
}

void TiffFile::readTiles(const Layout& layout, std::vector<std::byte>& pixels) {
  std::uint32_t tile_width = 0;
  std::uint32_t tile_height = 0;
  TIFFGetField(tiff_.get(), TIFFTAG_TILEWIDTH, &tile_width);
  TIFFGetField(tiff_.get(), TIFFTAG_TILELENGTH, &tile_height);
  const std::uint64_t tile_pixels = std::uint64_t{tile_width} * tile_height;
  if (tile_pixels == 0 || tile_pixels > kMostPixels ||
      tile_pixels * layout.sampleSize() / kTightestPacking > size_) {
    fail("claims tiles of " + std::to_string(tile_width) + " x " + std::to_string(tile_height) + " pixels");
  }
  const std::size_t sample = layout.sampleSize();
  std::vector<std::byte> tile(tile_pixels * sample);
  for (std::uint64_t y = 0; y < layout.height; y += tile_height) {
    for (std::uint64_t x = 0; x < layout.width; x += tile_width) {
      const auto wanted = static_cast<tmsize_t>(tile.size());
      const std::uint32_t index =
          TIFFComputeTile(tiff_.get(), static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), 0, 0);
      if (TIFFReadEncodedTile(tiff_.get(), index, tile.data(), wanted) != wanted) {
        fail("is truncated or damaged in tile " + std::to_string(index));
      }
      const std::size_t columns = std::min<std::uint64_t>(tile_width, layout.width - x) * sample;
      const std::uint64_t rows = std::min<std::uint64_t>(tile_height, layout.height - y);
      for (std::uint64_t row = 0; row < rows; ++row) {
        std::memcpy(pixels.data() + ((y + row) * layout.width + x) * sample,
                    tile.data() + row * tile_width * sample, columns);
      }
    }
  }
}

/// Celsius of the pixels in the byte order of this machine.
std::vector<float> decode(const Layout& layout, const std::vector<std::byte>& pixels,
                          const TLinear& t_linear) {
  std::vector<float> celsius(pixels.size() / layout.sampleSize());
  for (std::size_t i = 0; i < celsius.size(); ++i) {
    if (layout.floating) {
      float value = 0.0F;
      std::memcpy(&value, pixels.data() + i * sizeof value, sizeof value);
      const bool possible = std::isfinite(value) && value > kAbsoluteZero;
      celsius[i] = possible ? value : std::numeric_limits<float>::quiet_NaN();
    } else {
      std::uint16_t counts = 0;
      std::memcpy(&counts, pixels.data() + i * sizeof counts, sizeof counts);
      celsius[i] = t_linear.celsius(counts);
    }
  }
  return celsius;
}

ThermalImage TiffFile::read(int page, const TLinear& t_linear) {
  goTo(page);
  const Layout page_layout = layout();
  std::vector<std::byte> pixels(std::size_t{page_layout.width} * page_layout.height *
                                page_layout.sampleSize());
  if (TIFFIsTiled(tiff_.get()) != 0) {
    readTiles(page_layout, pixels);
  } else {
    readStrips(page_layout, pixels);
  }
  return {static_cast<int>(page_layout.width), static_cast<int>(page_layout.height),
          decode(page_layout, pixels, t_linear)};
}

}  // namespace

ThermalImage readThermalTiff(const std::filesystem::path& file, int page, const TLinear& t_linear) {
  return TiffFile(file).read(page, t_linear);
}

ThermalImage readThermalTiff(std::span<const std::byte> bytes, const std::string& name, int page,
                             const TLinear& t_linear) {
  return TiffFile(bytes, name).read(page, t_linear);
}

ThermalPixels thermalTiffPixels(const std::filesystem::path& file) {
  return TiffFile(file).pixels();
}

int thermalTiffPages(const std::filesystem::path& file) {
  return TiffFile(file).pages();
}

}  // namespace thermovox
