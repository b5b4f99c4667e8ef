#include "io/thermal_tiff_writer.hpp"

#include <fmt/format.h>

#include <cassert>
#include <limits>
#include <string_view>
#include <utility>
#include <vector>

#include "io/little_endian.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

enum class FieldType : std::uint16_t { bytes = 1, text = 2, number16 = 3, number32 = 4, number64 = 16 };

/// A field of a page's directory: a number, or bytes that stand behind the directory where they are long.
struct Field {
  std::uint16_t tag = 0;
  FieldType type = FieldType::number32;
  std::uint64_t number = 0;
  std::string bytes;
};

std::string xmpPacket(double gain) {
  return fmt::format(
      "<x:xmpmeta xmlns:x=\"adobe:ns:meta/\"><rdf:RDF "
      "xmlns:rdf=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\"><rdf:Description rdf:about=\"\" "
      "xmlns:Camera=\"http://pix4d.com/camera/1.0\" "
      "Camera:TlinearGain=\"{}\"/></rdf:RDF></x:xmpmeta>",
      gain);
}

void appendOffset(std::string& bytes, std::uint64_t offset, bool big) {
  if (big) {
    appendLittleEndian(bytes, offset);
  } else {
    appendLittleEndian(bytes, static_cast<std::uint32_t>(offset));
  }
}

}  // namespace

struct ThermalTiffWriter::Page {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  bool floating = false;
  std::string pixels;
};

namespace {

/// In the order of their plan. The pixels' place is filled in where the directory's size is known.
std::vector<Field> fieldsOf(std::uint32_t width, std::uint32_t height, bool floating, const TiffPlan& plan) {
  const unsigned bits = floating ? 32 : 16;
  std::vector<Field> fields{{256, FieldType::number32, width},
                            {257, FieldType::number32, height},
                            {258, FieldType::number16, bits},
                            {259, FieldType::number16, 1},
                            {262, FieldType::number16, 1}};
  if (!plan.make.empty()) fields.push_back({271, FieldType::text, 0, plan.make + '\0'});
  if (!plan.model.empty()) fields.push_back({272, FieldType::text, 0, plan.model + '\0'});
  fields.push_back({273, FieldType::number64, 0});
  fields.push_back({277, FieldType::number16, 1});
  fields.push_back({278, FieldType::number32, height});
  fields.push_back({279, FieldType::number64, std::uint64_t{width} * height * bits / 8});
  fields.push_back({305, FieldType::text, 0, std::string("thermovox") + '\0'});
  fields.push_back({339, FieldType::number16, floating ? 3U : 1U});
  if (plan.t_linear_gain) fields.push_back({700, FieldType::bytes, 0, xmpPacket(*plan.t_linear_gain)});
  return fields;
}

/// The directory of a page that begins at `place`, with what stands behind it; the pixels come next.
std::string directoryOf(std::vector<Field> fields, std::uint64_t place, bool last, bool big) {
  const std::size_t value_size = big ? 8 : 4;
  const std::size_t head = (big ? 8 : 2) + fields.size() * (big ? 20 : 12) + value_size;
  std::string behind;
  std::uint64_t pixel_bytes = 0;
  for (const Field& field : fields) {
    if (field.tag == 279) pixel_bytes = field.number;
    if (field.bytes.size() > value_size) behind += field.bytes;
  }
  behind.resize(behind.size() + (head + behind.size()) % 2);  // the pixels begin at an even place
  const std::uint64_t pixels = place + head + behind.size();
  std::string entries;
  std::uint64_t text_place = place + head;
  for (Field& field : fields) {
    if (field.tag == 273) field.number = pixels;
    if (field.type == FieldType::number64 && !big) field.type = FieldType::number32;
    appendLittleEndian(entries, field.tag);
    appendLittleEndian(entries, static_cast<std::uint16_t>(field.type));
    appendOffset(entries, field.bytes.empty() ? 1 : field.bytes.size(), big);
    if (field.bytes.empty()) {
      appendOffset(entries, field.number, big);  // shorter numbers stand in the first bytes
    } else if (field.bytes.size() > value_size) {
      appendOffset(entries, text_place, big);
      text_place += field.bytes.size();
    } else {
      entries += field.bytes + std::string(value_size - field.bytes.size(), '\0');
    }
  }
  std::string directory;
  if (big) {
    appendLittleEndian(directory, static_cast<std::uint64_t>(fields.size()));
  } else {
    appendLittleEndian(directory, static_cast<std::uint16_t>(fields.size()));
  }
  directory += entries;
  appendOffset(directory, last ? 0 : pixels + pixel_bytes, big);
  return directory + behind;
}

}  // namespace

ThermalTiffWriter::ThermalTiffWriter(const std::filesystem::path& path, Existing existing, TiffPlan plan)
    : name_(path.string()), file_(path, existing), plan_(std::move(plan)), pages_left_(plan_.pages) {}

void ThermalTiffWriter::add(const ThermalImage& image) {
  Page page{static_cast<std::uint32_t>(image.width), static_cast<std::uint32_t>(image.height), true, {}};
  page.pixels.reserve(image.celsius.size() * sizeof(float));
  for (const float celsius : image.celsius) appendLittleEndian(page.pixels, celsius);
  write(page);
}

void ThermalTiffWriter::add(int width, int height, std::span<const std::uint16_t> counts) {
  Page page{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), false, {}};
  page.pixels.reserve(counts.size_bytes());
  for (const std::uint16_t count : counts) appendLittleEndian(page.pixels, count);
  write(page);
}

void ThermalTiffWriter::write(const Page& page) {
  assert(pages_left_ > 0);
  if (place_ == 0) {
    // Half of what a TIFF can address leaves room for frames that are larger than the first.
    constexpr std::uint64_t enough = std::uint64_t{1} << 31;
    plan_.big = plan_.big || static_cast<std::uint64_t>(pages_left_) * (page.pixels.size() + 1024) > enough;
    std::string header = "II";
    if (plan_.big) {
      for (const int number : {43, 8, 0}) appendLittleEndian(header, static_cast<std::uint16_t>(number));
      appendLittleEndian(header, std::uint64_t{16});
    } else {
      appendLittleEndian(header, std::uint16_t{42});
      appendLittleEndian(header, std::uint32_t{8});
    }
    file_.write(header);
    place_ = header.size();
  }
  --pages_left_;
  const std::string directory = directoryOf(fieldsOf(page.width, page.height, page.floating, plan_), place_,
                                            pages_left_ == 0, plan_.big);
  file_.write(directory);
  file_.write(page.pixels);
  place_ += directory.size() + page.pixels.size();
  if (!plan_.big && place_ > std::numeric_limits<std::uint32_t>::max())
    throw DataError(name_ + ": is larger than 4 GB, expected pages of about the size of the first");
}

void ThermalTiffWriter::commit() {
  assert(pages_left_ == 0);
  file_.commit();
}

}  // namespace thermovox
