#include <thread>

#include "io/thermal_recording.hpp"
#include "tests/apps/program.hpp"
#include "tests/io/flir_file.hpp"

namespace thermovox::test {
namespace {

using testing::HasSubstr;

class ImageWatchVerb : public testing::Test {
 protected:
  static std::string image(std::uint64_t seed) {
    return radiometricJpeg(
        flirFrame({.width = 40, .height = 30, .counts = calmCounts(40, 30, seed), .parameters = e40()}));
  }
  [[nodiscard]] Outcome watch(const std::string& arguments) const {
    return thermovox(folder.path(), "image --watch card out --settled 0.2 " + arguments);
  }

  TestFolder folder;
};

TEST_F(ImageWatchVerb, TurnsEveryImageIntoAFileAndPassesOverOthers) {
  folder.write("card/DCIM/a.jpg", image(1));
  folder.write("card/b.jpg", "no image at all");
  folder.write("card/notes.txt", "nor this");
  const Outcome outcome = watch("--idle 1.5");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("out/DCIM/a.jpg.tiff: 40 x 30, "));
  EXPECT_THAT(outcome.err, HasSubstr("card/b.jpg"));
  EXPECT_EQ(namesUnder(folder / "out"), (std::set<std::string>{"DCIM", "DCIM/a.jpg.tiff"}));
  EXPECT_EQ(openThermalRecording(folder / "out/DCIM/a.jpg.tiff")->read(0).celsius.size(), 1200U);
}

TEST_F(ImageWatchVerb, GivesImagesThatAppearWhileItWatches) {
  std::thread camera([this] {
    std::this_thread::sleep_for(std::chrono::milliseconds(700));
    folder.write("card/a.jpg", image(1));
    std::this_thread::sleep_for(std::chrono::milliseconds(700));
    folder.write("card/b.jpg", image(2));
  });
  const Outcome outcome = watch("--images 2 --idle 60 --as png");
  camera.join();
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(namesUnder(folder / "out"), (std::set<std::string>{"a.jpg.png", "b.jpg.png"}));
}

TEST_F(ImageWatchVerb, KeepsFilesOfAnEarlierRunUnlessForced) {
  folder.write("card/a.jpg", image(1));
  folder.write("out/a.jpg.tiff", "of an earlier run");
  EXPECT_EQ(watch("--idle 1").code, 0);
  EXPECT_EQ(bytesOf(folder / "out/a.jpg.tiff"), "of an earlier run");
  EXPECT_EQ(watch("--idle 1 --force").code, 0);
  EXPECT_NE(bytesOf(folder / "out/a.jpg.tiff"), "of an earlier run");
}

TEST_F(ImageWatchVerb, WritesAllFramesOfARecordingIntoATiffAndNoneIntoAPicture) {
  const auto frame = [](std::uint64_t seed) {
    return flirFrame({.width = 40, .height = 30, .counts = calmCounts(40, 30, seed), .parameters = e40()});
  };
  folder.write("card/a.seq", frame(1) + frame(2));
  EXPECT_EQ(watch("--idle 1 --all").code, 0);
  EXPECT_EQ(openThermalRecording(folder / "out/a.seq.tiff")->frames(), 2);
  EXPECT_EQ(watch("--idle 1 --all --as png").code, 2);
  EXPECT_EQ(watch("--idle 1 --edges").code, 2);
}

TEST_F(ImageWatchVerb, EndsWhereItCannotWrite) {
  folder.write("card/a.jpg", image(1));
  folder.write("out", "is no folder");
  const Outcome outcome = watch("--idle 20");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("out"));
}

TEST_F(ImageWatchVerb, RefusesToWatchItsOwnFiles) {
  EXPECT_EQ(thermovox(folder.path(), "image --watch . out").code, 2);
  EXPECT_EQ(thermovox(folder.path(), "image a.jpg a.png --as png").code, 2);
}

}  // namespace
}  // namespace thermovox::test
