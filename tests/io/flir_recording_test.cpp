#include "io/flir_recording.hpp"

#include <gmock/gmock.h>

#include "io/celsius_decoder.hpp"
#include "projection/error.hpp"
#include "tests/io/flir_file.hpp"
#include "tests/support/recordings.hpp"

namespace thermovox {
namespace {

using test::FlirFile;
using test::FlirPacking;
using test::messageOf;
using testing::AllOf;
using testing::HasSubstr;

/// Frames that differ in everything that a frame can: size, packing, byte order, emissivity.
std::vector<FlirFile> differentFrames() {
  std::vector<FlirFile> frames;
  const FlirPacking packings[] = {FlirPacking::raw_little, FlirPacking::jpeg_ls, FlirPacking::png,
                                  FlirPacking::raw_big, FlirPacking::jpeg_ls};
  for (int i = 0; i < 5; ++i) {
    FlirFile file{.width = 20 + i,
                  .height = 15,
                  .counts = test::calmCounts(20 + i, 15, 10U + i),
                  .packing = packings[i],
                  .parameters = test::e40()};
    file.container = i % 2 == 0 ? ByteOrder::little : ByteOrder::big;
    file.parameters.emissivity = 0.5 + 0.0625 * i;
    file.picture_in_picture = i == 2;
    frames.push_back(file);
  }
  return frames;
}

std::string recordingOf(const std::vector<FlirFile>& frames, const std::string& between = "") {
  std::string bytes;
  for (const FlirFile& frame : frames) bytes += flirFrame(frame) + between;
  return bytes;
}

void expectFrames(ThermalRecording& recording, const std::vector<FlirFile>& frames) {
  ASSERT_EQ(recording.frames(), static_cast<int>(frames.size()));
  for (const int i : {4, 0, 1, 2, 3, 2}) {  // in any order
    const RawThermalImage image = recording.read(i);
    const FlirFile& expected = frames[static_cast<std::size_t>(i)];
    EXPECT_EQ(image.width, expected.width);
    EXPECT_EQ(image.counts, expected.counts) << "frame " << i;
    EXPECT_EQ(std::get<RadiometricParameters>(image.rule).emissivity, expected.parameters.emissivity);
  }
}

TEST(FlirRecording, GivesFramesOfAnySizeEachWithItsOwnCamera) {
  const test::TestFolder folder;
  const std::vector<FlirFile> frames = differentFrames();
  for (const std::string& between : {std::string(), std::string(13, '\0'), std::string(200'000, 'F')}) {
    SCOPED_TRACE(testing::Message() << between.size() << " bytes between the frames");
    const std::string bytes = recordingOf(frames, between);
    expectFrames(*openThermalRecording(folder.write("flight.seq", bytes)), frames);
    expectFrames(*openThermalRecording(std::as_bytes(std::span(bytes)), "memory"), frames);
  }
}

TEST(FlirRecording, NamesTheFrameThatItDoesNotHave) {
  const std::string bytes = recordingOf(differentFrames());
  const auto recording = openThermalRecording(std::as_bytes(std::span(bytes)), "flight.seq");
  for (const int frame : {-1, 5}) {
    EXPECT_THAT(
        messageOf<DataError>([&] { static_cast<void>(recording->read(frame)); }),
        AllOf(HasSubstr("flight.seq: has no frame " + std::to_string(frame)), HasSubstr("expected 0 to 4")));
  }
}

TEST(FlirRecording, EndsBeforeAFrameThatIsCutOff) {
  const std::vector<FlirFile> frames = differentFrames();
  const std::string bytes = recordingOf(frames);
  const std::size_t first = flirFrame(frames[0]).size();
  const std::size_t second = flirFrame(frames[1]).size();
  for (std::size_t size = 64; size + 4 < first + second; size += 11) {
    SCOPED_TRACE(testing::Message() << size << " of " << first << " + " << second << " bytes");
    const std::string cut = bytes.substr(0, size);
    const auto open = [&] { return openThermalRecording(std::as_bytes(std::span(cut)), "flight.seq"); };
    if (size < first) {
      EXPECT_THAT(messageOf<DataError>([&] { static_cast<void>(open()); }), HasSubstr("flight.seq: "));
      continue;
    }
    const auto recording = open();
    EXPECT_EQ(recording->frames(), 1);
    EXPECT_EQ(recording->read(0).counts, frames[0].counts);
  }
}

TEST(FlirRecording, NamesADamagedFrameInTheMiddleAndGivesTheOthers) {
  std::vector<FlirFile> frames = differentFrames();
  std::string bytes = recordingOf(frames);
  const std::size_t png = bytes.find("IDAT");
  for (std::size_t i = 8; i < 40; ++i) bytes[png + i] = '\x55';
  const auto recording = openThermalRecording(std::as_bytes(std::span(bytes)), "flight.seq");
  ASSERT_EQ(recording->frames(), 5);
  EXPECT_THAT(messageOf<DataError>([&] { static_cast<void>(recording->read(2)); }),
              HasSubstr("flight.seq, frame 2: the record of the counts is a damaged PNG"));
  EXPECT_EQ(recording->read(3).counts, frames[3].counts);
}

/// The frame, in whose directory a number of the record of this type is two thousand million. Little endian.
std::string withDamagedRecord(std::string frame, std::uint16_t type, std::size_t place_in_entry) {
  const auto number = [&frame](std::size_t place) {
    return *numberAt<std::uint32_t>(std::as_bytes(std::span(frame)), place, ByteOrder::little);
  };
  for (std::uint32_t i = 0; i < number(0x1C); ++i) {
    const std::size_t entry = number(0x18) + 32 * i;
    if ((number(entry) & 0xFFFF) == type) return frame.replace(entry + place_in_entry, 4, "\xFF\xFF\xFF\x7F");
  }
  ADD_FAILURE() << "no record of type " << type;
  return frame;
}

TEST(FlirRecording, FindsWhatFollowsAFrameThatClaimsTheRestOfTheFile) {
  constexpr std::size_t offset = 12, size = 16;
  constexpr std::uint16_t counts = 0x01, picture_in_picture = 0x2A;
  struct Damage {
    std::uint16_t type;
    std::size_t place;
    bool usable;  ///< the frame, all the same
  };
  const std::vector<FlirFile> frames = differentFrames();
  for (const auto& [type, place, usable] :
       {Damage{picture_in_picture, size, true}, {counts, size, true}, {counts, offset, false}}) {
    std::string bytes;
    for (std::size_t i = 0; i < frames.size(); ++i)
      bytes += i == 2 ? withDamagedRecord(flirFrame(frames[i]), type, place) : flirFrame(frames[i]);
    const auto recording = openThermalRecording(std::as_bytes(std::span(bytes)), "flight.seq");
    ASSERT_EQ(recording->frames(), 5);  // those that follow keep their numbers
    if (usable) {
      EXPECT_EQ(recording->read(2).counts, frames[2].counts);
    } else {
      EXPECT_THAT(messageOf<DataError>([&] { static_cast<void>(recording->read(2)); }),
                  HasSubstr("flight.seq, frame 2: is damaged"));
    }
    EXPECT_EQ(recording->read(3).counts, frames[3].counts);
    EXPECT_EQ(recording->read(4).counts, frames[4].counts);
  }
}

}  // namespace
}  // namespace thermovox
