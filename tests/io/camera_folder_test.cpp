#include "io/camera_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/recordings.hpp"

namespace thermovox {
namespace {

namespace fs = std::filesystem;
using test::TestFolder;
using namespace std::chrono_literals;

constexpr auto kSoon = 20s;       // for what must come, on any machine
constexpr auto kAWhile = 300ms;   // for what must not
constexpr auto kSettled = 100ms;  // without word from the kernel
constexpr auto kNever = 1h;

void put(const fs::path& file, const std::string& content) {
  std::ofstream(file, std::ios::binary) << content;
}

void setAge(const fs::path& file, std::chrono::seconds age) {
  fs::last_write_time(file, fs::file_time_type::clock::now() - age);
}

/// All that comes without waiting longer than for the first.
std::vector<std::string> namesOf(CameraFolder& images, std::size_t count) {
  std::vector<std::string> names;
  while (names.size() < count) {
    const auto image = images.next(kSoon);
    if (!image) break;
    names.push_back(image->filename());
  }
  return names;
}

class AnyCameraFolder : public testing::TestWithParam<FolderEvents::Source> {
 protected:
  [[nodiscard]] CameraFolder open(CameraFolder::Order order = CameraFolder::Order::oldest_first) const {
    return CameraFolder(folder.path(),
                        {.order = order, .settled = kSettled, .look_every = 20ms, .events = GetParam()});
  }
  TestFolder folder;
};

TEST_P(AnyCameraFolder, GivesWhatIsThereInTheOrderAskedFor) {
  for (const auto& [name, age] : {std::pair{"b.jpg", 30s}, {"a.TIFF", 10s}, {"c.csq", 20s}}) {
    put(folder / name, name);
    setAge(folder / name, age);
  }
  CameraFolder oldest = open();
  CameraFolder newest = open(CameraFolder::Order::newest_first);
  ASSERT_TRUE(oldest.next(kSoon).has_value());
  std::this_thread::sleep_for(3 * kSettled);
  EXPECT_FALSE(newest.next(0ms).has_value()) << "was not seen to stand still yet";
  std::this_thread::sleep_for(3 * kSettled);
  EXPECT_EQ(namesOf(newest, 3), (std::vector<std::string>{"a.TIFF", "c.csq", "b.jpg"}));
  EXPECT_EQ(namesOf(oldest, 2), (std::vector<std::string>{"c.csq", "a.TIFF"}));
  EXPECT_FALSE(oldest.next(kAWhile).has_value());
  EXPECT_FALSE(newest.next(kAWhile).has_value());
}

TEST_P(AnyCameraFolder, GivesEachNewImageOnceAlsoFromFoldersThatAppear) {
  CameraFolder images = open();
  EXPECT_FALSE(images.next(0ms).has_value());
  put(folder / "1.jpg", "one");
  EXPECT_EQ(images.next(kSoon), folder / "1.jpg");
  fs::create_directories(folder / "DCIM" / "101FLIR");
  put(folder / "DCIM" / "101FLIR" / "1.jpg", "one");
  EXPECT_EQ(images.next(kSoon), folder / "DCIM" / "101FLIR" / "1.jpg");
  put(folder / "2.jpg", "two");
  EXPECT_EQ(images.next(kSoon), folder / "2.jpg");
  EXPECT_FALSE(images.next(kAWhile).has_value());
}

TEST_P(AnyCameraFolder, WaitsUntilAnImageIsWhole) {
  CameraFolder images(folder.path(), {.settled = 3s, .look_every = 20ms, .events = GetParam()});
  EXPECT_FALSE(images.next(0ms).has_value());
  std::ofstream stream(folder / "1.jpg", std::ios::binary);
  for (int i = 0; i < 20; ++i) {
    stream << "a part" << std::flush;
    const auto image = images.next(20ms);
    ASSERT_FALSE(image.has_value()) << i;
  }
  stream.close();
  const auto image = images.next(kSoon);
  ASSERT_EQ(image, folder / "1.jpg");
  EXPECT_EQ(fs::file_size(*image), 20U * 6U);
  EXPECT_FALSE(images.next(kAWhile).has_value());
}

TEST_P(AnyCameraFolder, GivesNothingAgainWhenTheCardIsBack) {
  const fs::path card = folder / "card";
  CameraFolder images(card, {.settled = kSettled, .look_every = 20ms, .events = GetParam()});
  EXPECT_FALSE(images.next(kAWhile).has_value()) << "no card yet";
  fs::create_directory(card);
  put(card / "1.jpg", "one");
  put(card / "2.jpg", "two");
  EXPECT_EQ(namesOf(images, 2).size(), 2U);
  fs::rename(card, folder / "away");
  EXPECT_FALSE(images.next(kAWhile).has_value());
  setAge(folder / "away" / "1.jpg", 7200s);  // the card's clock has no time zone
  put(folder / "away" / "2.jpg", "otherwise");
  put(folder / "away" / "3.jpg", "three");
  setAge(folder / "away" / "2.jpg", 20s);
  fs::rename(folder / "away", card);
  EXPECT_EQ(namesOf(images, 2), (std::vector<std::string>{"2.jpg", "3.jpg"}));
  EXPECT_FALSE(images.next(kAWhile).has_value());
  put(card / "4.jpg", "four");
  EXPECT_EQ(images.next(kSoon), card / "4.jpg");
}

TEST_P(AnyCameraFolder, OverlooksWhatIsNoImage) {
  fs::create_directory(folder / ".Trashes");
  for (const char* name : {"1.txt", ".1.jpg", "1.jpg.part", ".Trashes/1.jpg"})
    put(folder / name, "something");
  put(folder / "empty.jpg", "");
  fs::create_directory(folder / "folder.jpg");
  CameraFolder images = open();
  EXPECT_FALSE(images.next(kAWhile).has_value());
  put(folder / "empty.jpg", "no more");
  EXPECT_EQ(images.next(kSoon), folder / "empty.jpg");
}

TEST_P(AnyCameraFolder, PassesOverWhatIsThere) {
  put(folder / "1.jpg", "one");
  CameraFolder images = open();
  images.passOver();
  EXPECT_FALSE(images.next(kAWhile).has_value());
  put(folder / "2.jpg", "two");
  EXPECT_EQ(images.next(kSoon), folder / "2.jpg");
}

TEST_P(AnyCameraFolder, GivesAgainWhatWasPutBack) {
  CameraFolder images = open();
  put(folder / "1.jpg", "one");
  ASSERT_EQ(images.next(kSoon), folder / "1.jpg");
  EXPECT_FALSE(images.next(kAWhile).has_value());
  images.putBack(folder / "1.jpg");
  EXPECT_EQ(images.next(kSoon), folder / "1.jpg");
  EXPECT_FALSE(images.next(kAWhile).has_value());
}

TEST_P(AnyCameraFolder, ReadsLittleOfLargeImagesToKnowThem) {
  const fs::path card = folder / "card";
  fs::create_directory(card);
  for (const char* name : {"old.seq", "new.seq"}) put(card / name, "a recording");
  // Of holes: reading them all would take minutes.
  constexpr std::uintmax_t size = 200'000'000'000;
  std::error_code error;
  fs::resize_file(card / "old.seq", size, error);
  if (error) GTEST_SKIP() << "the file system takes no file of 200 GB";
  fs::rename(card / "new.seq", folder / "new.seq");
  CameraFolder images(card, {.settled = kSettled, .look_every = 20ms, .events = GetParam()});
  images.passOver();
  fs::resize_file(folder / "new.seq", size);
  fs::rename(folder / "new.seq", card / "new.seq");
  EXPECT_EQ(images.next(kSoon), card / "new.seq");
  setAge(card / "old.seq", 7200s);
  setAge(card / "new.seq", 7200s);
  EXPECT_FALSE(images.next(kAWhile).has_value());
}

TEST_P(AnyCameraFolder, SeesAnotherLargeImageOfTheSameSize) {
  const std::string large(1'000'000, 'x');
  CameraFolder images = open();
  put(folder / "1.tiff", large);
  setAge(folder / "1.tiff", 100s);
  ASSERT_EQ(images.next(kSoon), folder / "1.tiff");
  for (const std::size_t begin : {0U, 400'000U, 900'000U}) {
    std::string other = large;
    std::fill_n(other.begin() + static_cast<std::ptrdiff_t>(begin), 100'000,
                static_cast<char>('a' + begin / 100'000));
    put(folder / "1.tiff", other);
    EXPECT_EQ(images.next(kSoon), folder / "1.tiff") << begin;
  }
  std::string other_end = large;
  other_end.back() = 'y';
  put(folder / "1.tiff", other_end);
  EXPECT_EQ(images.next(kSoon), folder / "1.tiff") << "its last byte";
  EXPECT_FALSE(images.next(kAWhile).has_value());
}

TEST_P(AnyCameraFolder, GivesEachOfManyImagesThatComeAtOnceOnce) {
  CameraFolder images = open();
  EXPECT_FALSE(images.next(0ms).has_value());
  std::vector<std::string> names;
  for (int i = 100; i < 300; ++i) {
    names.push_back(std::to_string(i) + ".jpg");
    put(folder / names.back(), names.back());
  }
  std::this_thread::sleep_for(3 * kSettled);
  const std::vector<std::string> given = namesOf(images, names.size());
  EXPECT_EQ(std::set(given.begin(), given.end()), std::set(names.begin(), names.end()));
  EXPECT_EQ(given.size(), names.size());
  EXPECT_FALSE(images.next(kAWhile).has_value());
}

INSTANTIATE_TEST_SUITE_P(Both, AnyCameraFolder,
                         testing::Values(FolderEvents::Source::kernel, FolderEvents::Source::none),
                         [](const auto& test) {
                           return test.param == FolderEvents::Source::kernel ? "events" : "looking";
                         });

TEST(CameraFolder, WaitsForAFileThatIsKnownToBeOpen) {
  const TestFolder folder;
  CameraFolder images(folder.path(), {.settled = 50ms, .look_every = 20ms});
  EXPECT_FALSE(images.next(0ms).has_value());
  std::ofstream stream(folder / "1.seq", std::ios::binary);
  stream << "a part" << std::flush;
  EXPECT_FALSE(images.next(500ms).has_value());
  stream << "and the rest";
  stream.close();
  EXPECT_EQ(images.next(kSoon), folder / "1.seq");
  EXPECT_FALSE(images.next(kAWhile).has_value());
}

TEST(CameraFolder, DoesNotGiveWhatIsWrittenAgainBeforeItsTurn) {
  const TestFolder folder;
  CameraFolder images(folder.path(), {.settled = kNever, .settled_open = kNever, .look_every = kNever});
  EXPECT_FALSE(images.next(0ms).has_value());
  put(folder / "1.part", "one");
  setAge(folder / "1.part", 20s);  // the kernel takes that for a change, so before it has its name
  fs::rename(folder / "1.part", folder / "1.jpg");
  put(folder / "2.jpg", "two");
  ASSERT_EQ(images.next(kSoon), folder / "1.jpg");
  std::ofstream again(folder / "2.jpg", std::ios::binary);
  again << "two, and" << std::flush;
  EXPECT_FALSE(images.next(kAWhile).has_value());
  again << " once more";
  again.close();
  ASSERT_EQ(images.next(kSoon), folder / "2.jpg");
  EXPECT_EQ(fs::file_size(folder / "2.jpg"), 18U);
  EXPECT_FALSE(images.next(kAWhile).has_value());
}

TEST(CameraFolder, HearsFromTheKernelThatAnImageIsWhole) {
  const TestFolder folder;
  CameraFolder images(folder.path(), {.settled = kNever, .look_every = kNever});
  EXPECT_FALSE(images.next(0ms).has_value());
  std::ofstream stream(folder / "1.jpg", std::ios::binary);
  stream << "a part" << std::flush;
  EXPECT_FALSE(images.next(kAWhile).has_value());
  std::thread camera([&] {
    std::this_thread::sleep_for(50ms);
    stream << "and the rest";
    stream.close();
  });
  EXPECT_EQ(images.next(kSoon), folder / "1.jpg");
  camera.join();
  put(folder / "2.part", "moved when it is whole");
  fs::rename(folder / "2.part", folder / "2.jpg");
  EXPECT_EQ(images.next(kSoon), folder / "2.jpg");
}

}  // namespace
}  // namespace thermovox
