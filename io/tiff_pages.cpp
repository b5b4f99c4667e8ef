#include "io/tiff_pages.hpp"

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

#include "io/byte_order.hpp"
#include "io/input_file.hpp"
#include "io/pixel_claim.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

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

/// Pixels in the byte order of this machine as counts or temperatures.
void putPixels(const Layout& layout, const std::vector<std::byte>& pixels, RawThermalImage& image) {
  const std::size_t count = pixels.size() / layout.sampleSize();
  if (!layout.floating) {
    image.counts.resize(count);
    std::memcpy(image.counts.data(), pixels.data(), count * sizeof(std::uint16_t));
    return;
  }
  image.celsius.resize(count);
  std::memcpy(image.celsius.data(), pixels.data(), count * sizeof(float));
  for (float& celsius : image.celsius) {
    const bool possible = std::isfinite(celsius) && celsius > kAbsoluteZero;
    if (!possible) celsius = std::numeric_limits<float>::quiet_NaN();
  }
}

}  // namespace

/// The file as libtiff has it open.
class TiffPages::File {
 public:
  File(const std::filesystem::path& path, std::string name) : name_(std::move(name)) {
    static_cast<void>(openInput(path));  // says why a file cannot be read
    std::error_code no_size;
    size_ = std::filesystem::file_size(path, no_size);
    if (no_size) fail("is no regular file");
    tiff_.reset(TIFFOpenExt(path.c_str(), "r", options().get()));
    if (!tiff_) fail("is not a readable TIFF");
  }
  File(std::span<const std::byte> bytes, std::string name)
      : name_(std::move(name)), memory_{bytes}, size_(bytes.size()) {
    tiff_.reset(TIFFClientOpenExt(name_.c_str(), "rm", &memory_, readMemory, writeNothing, seekMemory,
                                  closeNothing, sizeOfMemory, nullptr, nullptr, options().get()));
    if (!tiff_) fail("is not a readable TIFF");
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  /// libtiff counts none where the first page's directory is there but damaged in what leads on.
  [[nodiscard]] int pages() { return std::max(1, static_cast<int>(TIFFNumberOfDirectories(tiff_.get()))); }
  [[nodiscard]] const std::string& name() const { return name_; }
  void goTo(int page);
  /// Pixels, counts or floats, of the current page.
  [[nodiscard]] RawThermalImage read();
  [[nodiscard]] std::string text(ttag_t tag) const;
  /// The XMP packet of the current page; empty where it has none.
  [[nodiscard]] std::string xmp() const;

 private:
  [[nodiscard]] std::unique_ptr<TIFFOpenOptions, FreeOptions> options();
  [[nodiscard]] Layout layout();
  void readStrips(const Layout& layout, std::vector<std::byte>& pixels);
  void readTiles(const Layout& layout, std::vector<std::byte>& pixels);
  [[noreturn]] void fail(const std::string& what) const;

  std::string name_;
  MemoryFile memory_;
  std::uint64_t size_ = 0;  // bytes of the file
  Complaint complaint_;
  std::unique_ptr<TIFF, CloseTiff> tiff_;
};

std::unique_ptr<TIFFOpenOptions, FreeOptions> TiffPages::File::options() {
  std::unique_ptr<TIFFOpenOptions, FreeOptions> options(TIFFOpenOptionsAlloc());
  TIFFOpenOptionsSetMaxSingleMemAlloc(options.get(), kLargestAllocation);
  TIFFOpenOptionsSetErrorHandlerExtR(options.get(), keepComplaint, &complaint_);
  TIFFOpenOptionsSetWarningHandlerExtR(options.get(), passOver, nullptr);
  return options;
}

void TiffPages::File::fail(const std::string& what) const {
  throw DataError(name_ + ": " + what + (complaint_.text.empty() ? "" : " (" + complaint_.text + ")"));
}

void TiffPages::File::goTo(int page) {
  const int current = static_cast<int>(TIFFCurrentDirectory(tiff_.get()));
  if (page == current) return;
  // libtiff finds any other page from the first one on.
  const int found = page == current + 1 ? TIFFReadDirectory(tiff_.get())
                                        : TIFFSetDirectory(tiff_.get(), static_cast<tdir_t>(page));
  if (found == 0) fail("page " + std::to_string(page) + " cannot be read");
}

std::string TiffPages::File::text(ttag_t tag) const {
  const char* text = nullptr;
  if (TIFFGetField(tiff_.get(), tag, &text) != 1 || text == nullptr) return "";
  return textAt(std::as_bytes(std::span(text, std::strlen(text))), 0, 256);
}

std::string TiffPages::File::xmp() const {
  std::uint32_t size = 0;
  const char* packet = nullptr;
  if (TIFFGetField(tiff_.get(), TIFFTAG_XMLPACKET, &size, &packet) != 1 || packet == nullptr) return "";
  return {packet, size};
}

Layout TiffPages::File::layout() {
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
  checkClaim({layout.width, layout.height, layout.sampleSize(), size_}, name_ + ":");
  return layout;
}

void TiffPages::File::readStrips(const Layout& layout, std::vector<std::byte>& pixels) {
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

void TiffPages::File::readTiles(const Layout& layout, std::vector<std::byte>& pixels) {
  std::uint32_t tile_width = 0;
  std::uint32_t tile_height = 0;
  TIFFGetField(tiff_.get(), TIFFTAG_TILEWIDTH, &tile_width);
  TIFFGetField(tiff_.get(), TIFFTAG_TILELENGTH, &tile_height);
  checkClaim({tile_width, tile_height, layout.sampleSize(), size_}, name_ + ": a tile");
  const std::uint64_t tile_pixels = std::uint64_t{tile_width} * tile_height;
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

RawThermalImage TiffPages::File::read() {
  const Layout page = layout();
  std::vector<std::byte> pixels(std::size_t{page.width} * page.height * page.sampleSize());
  if (TIFFIsTiled(tiff_.get()) != 0) {
    readTiles(page, pixels);
  } else {
    readStrips(page, pixels);
  }
  RawThermalImage image{static_cast<int>(page.width), static_cast<int>(page.height)};
  putPixels(page, pixels, image);
  return image;
}

TiffPages::TiffPages(const std::filesystem::path& file, std::string name)
    : file_(std::make_unique<File>(file, std::move(name))), count_(file_->pages()) {}

TiffPages::TiffPages(std::span<const std::byte> bytes, std::string name)
    : file_(std::make_unique<File>(bytes, std::move(name))), count_(file_->pages()) {}

TiffPages::~TiffPages() = default;

int TiffPages::count() const {
  return count_;
}

RawThermalImage TiffPages::read(int page) {
  if (page < 0 || page >= count_) {
    throw DataError(file_->name() + ": has no page " + std::to_string(page) + ", expected 0 to " +
                    std::to_string(count_ - 1));
  }
  file_->goTo(page);
  return file_->read();
}

TiffTags TiffPages::tags() const {
  return {
      file_->text(TIFFTAG_MAKE),     file_->text(TIFFTAG_MODEL),    file_->text(TIFFTAG_CAMERASERIALNUMBER),
      file_->text(TIFFTAG_SOFTWARE), file_->text(TIFFTAG_DATETIME), file_->xmp()};
}

}  // namespace thermovox
