#include <cmath>

#include "io/celsius_decoder.hpp"
#include "io/thermal_recording.hpp"
#include "io/thermal_tiff_writer.hpp"
#include "tests/apps/program.hpp"
#include "tests/io/flir_file.hpp"
#include "tests/io/tiff_writer.hpp"

namespace thermovox::test {
namespace {

using testing::HasSubstr;

/// A folder with a radiometric JPEG, a recording of three frames and a TIFF of counts without a name.
class ImageVerb : public testing::Test {
 protected:
  ImageVerb() {
    folder.write("a.jpg", radiometricJpeg(flirFrame(frame(1))));
    folder.write("b.seq", flirFrame(frame(1)) + flirFrame(frame(2)) + flirFrame(frame(3)));
    writeTiff(folder / "c.tiff", TiffPages<std::uint16_t>{4, 3, {std::vector<std::uint16_t>(12, 30000)}});
  }

  static FlirFile frame(std::uint64_t seed) {
    return {.width = 40, .height = 30, .counts = calmCounts(40, 30, seed), .parameters = e40()};
  }
  [[nodiscard]] Outcome run(const std::string& arguments) const {
    return thermovox(folder.path(), "image " + arguments);
  }
  /// Runs, and reads a page of what was written.
  [[nodiscard]] RawThermalImage written(const std::string& arguments, int page = 0) const {
    const Outcome outcome = run(arguments + " out.tiff --force");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("out.tiff: "));
    return openThermalRecording(folder / "out.tiff")->read(page);
  }
  /// The temperature that these parameters make of a pixel of the first frame.
  static double expected(const RadiometricParameters& parameters, std::size_t pixel) {
    return celsiusOfCounts(frame(1).counts[pixel], parameters);
  }

  TestFolder folder;
};

TEST_F(ImageVerb, WritesTemperaturesByTheFilesOwnParameters) {
  const RawThermalImage image = written("a.jpg");
  ASSERT_EQ(image.celsius.size(), 1200U);
  EXPECT_NEAR(image.celsius[700], expected(e40(), 700), 1e-3);
  EXPECT_EQ(image.metadata.model, "FLIR E40");
}

TEST_F(ImageVerb, PutsEveryOverrideInPlace) {
  RadiometricParameters parameters = e40();
  parameters.emissivity = 0.7;
  parameters.distance = 30.0;
  parameters.reflected = -40.0;
  parameters.atmosphere_temperature = 10.0;
  parameters.humidity = 0.8;
  parameters.window_temperature = 35.0;
  parameters.window_transmission = 0.9;
  const std::string overrides =
      "a.jpg --emissivity 0.7 --distance 30 --reflected -40 --atmosphere-temperature 10 --humidity 0.8 "
      "--window-temperature 35 --window-transmission 0.9 ";
  EXPECT_NEAR(written(overrides).celsius[700], expected(parameters, 700), 1e-3);
  parameters.model = AtmosphereModel::half;
  EXPECT_NEAR(written(overrides + "--atmosphere-model half").celsius[700], expected(parameters, 700), 1e-3);
}

TEST_F(ImageVerb, WritesCountsAsTheyAreStored) {
  EXPECT_EQ(written("a.jpg --counts").counts, frame(1).counts);
  EXPECT_TRUE(std::holds_alternative<NotTemperature>(written("a.jpg --counts").rule))
      << "nobody may take them for temperatures";
}

TEST_F(ImageVerb, PicksOneFrameOrAll) {
  EXPECT_EQ(written("b.seq --counts").counts, frame(1).counts);
  EXPECT_EQ(written("b.seq --counts --frame 2").counts, frame(3).counts);
  EXPECT_EQ(written("b.seq --counts --all", 1).counts, frame(2).counts);
  EXPECT_EQ(openThermalRecording(folder / "out.tiff")->frames(), 3);
  expectRefused(folder.path(), "image b.seq x.tiff --frame 3", {"b.seq: has no frame 3", "0 to 2"});
}

TEST_F(ImageVerb, DrawsPictures) {
  for (const char* arguments : {"a.jpg p.png", "a.jpg p.jpg --palette ironbow --span 15 30",
                                "b.seq q.png --frame 1 --palette grey --percentile 0 100"}) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr(" C, mean "));
  }
  EXPECT_EQ(bytesOf(folder / "p.png").substr(1, 3), "PNG");
  EXPECT_EQ(bytesOf(folder / "p.jpg").substr(0, 2), "\xFF\xD8");
}

TEST_F(ImageVerb, TakesTheUsersScaleAndWarnsOfAGuess) {
  const Outcome guessed = run("c.tiff guess.tiff");
  EXPECT_EQ(guessed.code, 0);
  EXPECT_THAT(guessed.err, HasSubstr("does not say what its counts mean"));
  EXPECT_NEAR(openThermalRecording(folder / "guess.tiff")->read(0).celsius[0], 26.85, 1e-4);
  const Outcome told = run("c.tiff told.tiff --celsius-per-count 0.02 --celsius-offset -500");
  EXPECT_EQ(told.err, "");
  EXPECT_NEAR(openThermalRecording(folder / "told.tiff")->read(0).celsius[0], 100.0, 1e-4);
  expectRefused(folder.path(), "image a.jpg x.tiff --celsius-per-count 0.04", {"a.jpg", "of their own"});
  expectRefused(folder.path(), "image c.tiff x.tiff --emissivity 0.9", {"c.tiff", "camera's own making"});
}

TEST_F(ImageVerb, TakesTheRigsScaleBeforeTheFilesButNotBeforeTheUsers) {
  const auto rig = [&](const std::string& scale) {
    folder.write("rig.yaml",
                 "thermal_camera: {width: 4, height: 3, model: pinhole, fx: 4, fy: 4, cx: 1.5, cy: 1, " +
                     scale + "T_body_camera: {translation: [0, 0, 0], quaternion_xyzw: [0, 0, 0, 1]}}\n");
  };
  const auto celsius = [&](const std::string& arguments, const std::string& warning) {
    const Outcome outcome = run(arguments + " --force");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(warning));
    EXPECT_EQ(outcome.err.empty(), warning.empty()) << outcome.err;
    return openThermalRecording(folder / "x.tiff")->read(0).celsius[0];
  };
  rig("celsius_per_count: 0.02, celsius_offset: -500, ");
  EXPECT_NEAR(celsius("c.tiff x.tiff --rig rig.yaml", ""), 100.0, 1e-4);
  EXPECT_NEAR(celsius("c.tiff x.tiff --rig rig.yaml --celsius-per-count 0.01", ""), 26.85, 1e-4);
  EXPECT_EQ(run("a.jpg y.tiff --rig rig.yaml").code, 0) << "a radiometric file has its own parameters";
  ThermalTiffWriter said(folder / "d.tiff", Existing::refuse, {.t_linear_gain = 0.01});
  said.add(4, 3, std::vector<std::uint16_t>(12, 30000));
  said.commit();
  EXPECT_NEAR(celsius("d.tiff x.tiff --rig rig.yaml", "d.tiff: its counts are 0.01 C a count"), 100.0, 1e-4);
  rig("");
  EXPECT_NEAR(celsius("c.tiff x.tiff --rig rig.yaml", "does not say what its counts mean"), 26.85, 1e-4);
  EXPECT_NEAR(celsius("d.tiff x.tiff --rig rig.yaml", ""), 26.85, 1e-4);
}

TEST_F(ImageVerb, CountsWhatTheCameraIsNotCalibratedFor) {
  const Outcome outcome = run("a.jpg x.tiff --reflected 55 --emissivity 0.5");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("1200 pixels outside the calibrated -20 to 120 C"));
  EXPECT_LT(openThermalRecording(folder / "x.tiff")->read(0).celsius[0], -20.0) << "and keeps it";
  EXPECT_EQ(run("a.jpg x.png --reflected 55 --emissivity 0.5").code, 0);
}

TEST_F(ImageVerb, KeepsWhatIsThereUnlessForced) {
  folder.write("out.tiff", "mine");
  expectRefused(folder.path(), "image a.jpg out.tiff", {"out.tiff: exists already", "--force"});
  EXPECT_EQ(bytesOf(folder / "out.tiff"), "mine");
}

TEST_F(ImageVerb, RefusesWhatCannotBeMeant) {
  for (const char* arguments :
       {"a.jpg x.bmp", "a.jpg x.png --counts", "b.seq x.png --all", "b.seq x.tiff --all --frame 1",
        "a.jpg x.tiff --counts --emissivity 0.9", "c.tiff x.tiff --counts --rig rig.yaml",
        "a.jpg x.png --span 30 20", "a.jpg x.png --percentile 50 10",
        "a.jpg x.png --span 1 2 --percentile 1 99", "a.jpg x.tiff --emissivity 0",
        "a.jpg x.tiff --humidity 55", "a.jpg x.tiff --distance -1", "a.jpg x.png --palette pink",
        "a.jpg x.tiff --atmosphere-model third", "c.tiff x.tiff --celsius-offset 0", "a.jpg"}) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, 2) << arguments;
    EXPECT_EQ(outcome.out, "") << arguments;
    EXPECT_FALSE(std::filesystem::exists(folder / "x.tiff")) << arguments;
  }
}

TEST_F(ImageVerb, RefusesForATiffWhatOnlyAPictureHas) {
  for (const std::string option :
       {"--palette rainbow", "--palette inferno", "--span 1 2", "--percentile 1 99.9", "--edges",
        "--visible v.jpg --rig r.yaml --range 3"}) {
    const std::string name = option.substr(0, option.find(' '));
    for (const std::string& arguments : {"a.jpg x.tiff " + option, "a.jpg x.TIF --counts " + option}) {
      const Outcome outcome = run(arguments);
      EXPECT_EQ(outcome.code, 2) << arguments;
      EXPECT_THAT(outcome.err, HasSubstr(name + ": OUT is a TIFF")) << arguments;
    }
    const Outcome watch = run("--watch . ../out " + option);
    EXPECT_EQ(watch.code, 2) << option;
    EXPECT_THAT(watch.err, HasSubstr(name + ": --watch writes TIFFs")) << option;
  }
}

TEST_F(ImageVerb, SaysWhyAFileHoldsNoTemperatures) {
  FlirFile vue = frame(1);
  vue.model = "Vue Pro 640 13mm";
  folder.write("vue.jpg", radiometricJpeg(flirFrame(vue)));
  folder.write("photo.jpg", "\xFF\xD8\xFF\xD9");
  expectRefused(folder.path(), "image vue.jpg x.tiff", {"vue.jpg: is of a Vue Pro 640 13mm"});
  expectRefused(folder.path(), "image photo.jpg x.png", {"photo.jpg: is a JPEG without radiometric data"});
  const nlohmann::json vue_info = thermovox(folder.path(), "info vue.jpg --json").json();
  EXPECT_EQ(vue_info.at("radiometric"), false);
  EXPECT_THAT(vue_info.at("reason").get<std::string>(), HasSubstr("measures no temperatures"));
  EXPECT_GT(vue_info.at("counts").at("min"), 17000) << "there are counts all the same";
}

TEST_F(ImageVerb, AgreesWithInfo) {
  const nlohmann::json info = thermovox(folder.path(), "info b.seq --json").json();
  EXPECT_EQ(info.at("radiometric"), true);
  EXPECT_EQ(info.at("frames"), 3);
  EXPECT_EQ(info.at("camera").at("model"), "FLIR E40");
  EXPECT_NEAR(info.at("parameters").at("emissivity").get<double>(), 0.95, 1e-4);
  const RawThermalImage image = written("b.seq");
  const ThermalStatistics statistics = statisticsOf(CelsiusDecoder().decode(image, "out"), std::nullopt);
  EXPECT_NEAR(info.at("max").get<double>(), statistics.max.value(), 1e-4);
  EXPECT_NEAR(info.at("mean").get<double>(), statistics.mean.value(), 1e-4);
  const nlohmann::json& corner = info.at("pixels").at("bottom_right");
  EXPECT_EQ(corner.at("xy"), nlohmann::json({39, 29}));
  EXPECT_EQ(corner.at("counts").get<int>(), frame(1).counts.back());
  EXPECT_NEAR(corner.at("celsius").get<double>(), image.celsius.back(), 1e-4);
}

TEST_F(ImageVerb, TakesWhatTheUserKnowsBetterInInfoToo) {
  const auto info = [&](const std::string& arguments) {
    return thermovox(folder.path(), "info " + arguments + " --json");
  };
  const nlohmann::json told = info("a.jpg --emissivity 0.7 --distance 30 --reflected -40").json();
  EXPECT_NEAR(told.at("parameters").at("emissivity").get<double>(), 0.7, 1e-9);
  EXPECT_NEAR(told.at("pixels").at("top_left").at("celsius").get<double>(),
              written("a.jpg --emissivity 0.7 --distance 30 --reflected -40").celsius[0], 1e-4);
  const nlohmann::json scaled = info("c.tiff --celsius-per-count 0.02 --celsius-offset -500").json();
  EXPECT_EQ(scaled.at("scale").at("from"), "the user");
  EXPECT_NEAR(scaled.at("mean").get<double>(), 100.0, 1e-4);
  expectRefused(folder.path(), "info c.tiff --emissivity 0.7", {"c.tiff: has no radiometric parameters"});
  expectRefused(folder.path(), "info a.jpg --celsius-per-count 0.1", {"a.jpg: its pixels have a meaning"});
  folder.write("rig.yaml", "{}");
  EXPECT_EQ(info("rig.yaml --emissivity 0.7").code, 2);
  EXPECT_EQ(info("a.jpg --emissivity 7").code, 2);
}

TEST(ImageVerbOnRecordings, RefusesEveryNegativeFileInOneSentence) {
  THERMOVOX_NEEDS_RECORDINGS();
  const TestFolder folder;
  for (const auto& entry : std::filesystem::directory_iterator(*recordings() / "thermal" / "negative")) {
    const std::string file = "'" + entry.path().string() + "'";
    expectRefused(folder.path(), "image " + file + " x.png", {entry.path().filename().string() + ": "});
    const Outcome info = thermovox(folder.path(), "info " + file + " --json");
    EXPECT_EQ(info.code, 0);
    EXPECT_EQ(info.json().at("radiometric"), false);
    EXPECT_THAT(info.json().at("reason").get<std::string>(), testing::Not(testing::IsEmpty()));
  }
}

}  // namespace
}  // namespace thermovox::test
