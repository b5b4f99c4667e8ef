#include "mapping/hotspot_history.hpp"

#include <gmock/gmock.h>

#include <list>
#include <utility>

#include "mapping/hotspot_detection.hpp"
#include "tests/support/hot_surface.hpp"

namespace thermovox {
namespace {

using test::CelsiusAt;
using test::HotPeak;
using testing::IsEmpty;
using testing::SizeIs;

const Eigen::Vector3d kLeft(0.5, 0.75, 1.02), kRight(1.0, 0.75, 1.02);

/// Missions over one plate, each with noise of its own.
class Histories : public testing::Test {
 protected:
  /// The places of the spots may be off by `error` against the other missions, as their covariance says.
  void fly(const CelsiusAt& celsius, const Eigen::Vector3d& error = Eigen::Vector3d::Zero()) {
    const auto seed = static_cast<unsigned>(layers_.size()) + 1;
    const SurfaceLayer& layer =
        layers_.emplace_back(test::mapOf(test::returnsOf({}, celsius, {.seed = seed, .celsius = 0.1})));
    std::vector<Hotspot> spots = findHotspots(layer, {}, {.focal_px = 5000.0, .blur_px = 0.1});
    for (Hotspot& spot : spots) {
      spot.position.p_world += error;
      spot.position.common = 1e-4 * Eigen::Matrix3d::Identity();
    }
    history_.add({"mission " + std::to_string(seed), &layer, spots});
  }
  void fly(const std::vector<HotPeak>& peaks, double plate = 20.0) {
    fly([=](const Eigen::Vector3d& p) { return plate + test::riseAt(peaks, p); });
  }
  [[nodiscard]] HotspotState state(int id, std::size_t mission) const {
    return history_.tracks().at(static_cast<std::size_t>(id - 1)).changes.at(mission)->state;
  }
  [[nodiscard]] bool alarm(int id, std::size_t mission) const {
    return history_.tracks().at(static_cast<std::size_t>(id - 1)).changes.at(mission)->alarm;
  }
  /// The id of the track that has a spot near a place.
  [[nodiscard]] int idAt(const Eigen::Vector3d& p_world) const {
    for (const HotspotTrack& track : history_.tracks()) {
      if ((track.seen[track.lastSeen()]->position.p_world - p_world).norm() < 0.05) return track.id;
    }
    return 0;
  }

  std::list<SurfaceLayer> layers_;
  HotspotHistory history_;
};

TEST_F(Histories, TheFirstMissionsSpotsAreNewWithoutAlarm) {
  fly({{kLeft, 30.0, 0.06}, {kRight, 20.0, 0.06}});
  ASSERT_THAT(history_.tracks(), SizeIs(2));
  EXPECT_EQ(history_.tracks()[0].id, 1);  // the hottest first
  EXPECT_EQ(idAt(kLeft), 1);
  for (const int id : {1, 2}) {
    EXPECT_EQ(state(id, 0), HotspotState::fresh);
    EXPECT_FALSE(alarm(id, 0));
  }
}

TEST_F(Histories, ASpotThatStaysAsItIsIsSteady) {
  for (int i = 0; i < 6; ++i) fly({{kLeft, 30.0, 0.06}});
  ASSERT_THAT(history_.tracks(), SizeIs(1));
  for (std::size_t i = 1; i < 6; ++i) {
    EXPECT_EQ(state(1, i), HotspotState::steady) << i;
    EXPECT_FALSE(alarm(1, i));
  }
}

TEST_F(Histories, ASeasonRaisesNothingAndThreeDegreesOfOneJointRaiseOne) {
  fly({{kLeft, 30.0, 0.09}, {kRight, 20.0, 0.09}}, 5.0);
  fly({{kLeft, 30.0, 0.09}, {kRight, 23.0, 0.09}}, 20.0);
  ASSERT_THAT(history_.tracks(), SizeIs(2));
  EXPECT_EQ(state(idAt(kLeft), 1), HotspotState::steady);
  EXPECT_EQ(state(idAt(kRight), 1), HotspotState::growing);
  EXPECT_FALSE(alarm(idAt(kLeft), 1));
  EXPECT_TRUE(alarm(idAt(kRight), 1));
  const HotspotChange& change = *history_.tracks()[1].changes[1];
  EXPECT_NEAR(change.change.value, 3.0, 1.0);
  EXPECT_GT(change.significance(), 3.0);
}

TEST_F(Histories, ASpotThatCoolsIsCoolingWithoutAlarm) {
  fly({{kLeft, 40.0, 0.06}});
  fly({{kLeft, 30.0, 0.06}});
  EXPECT_EQ(state(1, 1), HotspotState::cooling);
  EXPECT_FALSE(alarm(1, 1));
}

TEST_F(Histories, ASpotThatWasMendedIsGoneAndOneThatNobodySawIsNot) {
  fly({{kLeft, 30.0, 0.06}, {kRight, 30.0, 0.06}});
  fly([](const Eigen::Vector3d& p) { return p.x() > 0.75 ? std::nan("") : 20.0; });
  EXPECT_EQ(state(idAt(kLeft), 1), HotspotState::gone);
  EXPECT_EQ(state(idAt(kRight), 1), HotspotState::not_observed);
  const HotspotTrack& mended = history_.tracks()[static_cast<std::size_t>(idAt(kLeft) - 1)];
  ASSERT_TRUE(mended.changes[1]->to);
  EXPECT_NEAR(mended.changes[1]->to->value, 0.0, 1.0);
  const HotspotTrack& unseen = history_.tracks()[static_cast<std::size_t>(idAt(kRight) - 1)];
  EXPECT_FALSE(unseen.changes[1]->to);
  EXPECT_EQ(unseen.changes[1]->change.value, 0.0);
  EXPECT_EQ(unseen.changes[1]->significance(), 0.0);
  // A mission without any temperature sees nothing go.
  fly([](const Eigen::Vector3d&) { return std::nan(""); });
  EXPECT_EQ(state(1, 2), HotspotState::not_observed);
  EXPECT_EQ(state(2, 2), HotspotState::not_observed);
}

TEST_F(Histories, WhatReadsLowIsABoundFromBelow) {
  // Spots by hand, of which the second and the fourth mission saw too little.
  const auto flyWith = [this](double delta, bool reads_low) {
    fly({{kLeft, 30.0, 0.06}});
    Hotspot spot = history_.missions().back().hotspots.at(0);
    spot.delta = {delta, 0.5};
    spot.is_bound = reads_low;
    return spot;
  };
  HotspotHistory history;
  for (const auto& [delta, low] : {std::pair{40.0, false}, {20.0, true}, {40.0, false}, {60.0, true}}) {
    const Hotspot spot = flyWith(delta, low);
    history.add({"m", &layers_.back(), {spot}});
  }
  ASSERT_THAT(history.tracks(), SizeIs(1));
  const auto& changes = history.tracks()[0].changes;
  EXPECT_EQ(changes[1]->state, HotspotState::steady);
  EXPECT_NEAR(changes[1]->change.value, -20.0, 1e-9);
  EXPECT_EQ(changes[2]->state, HotspotState::steady);
  EXPECT_NEAR(changes[2]->from->value, 40.0, 1e-9) << "not against what read low";
  EXPECT_EQ(changes[3]->state, HotspotState::growing);
  // From a bound nothing grows, to one nothing cools.
  EXPECT_EQ(history.between(1, 2).at(0).change.state, HotspotState::steady);
  EXPECT_EQ(history.between(0, 1).at(0).change.state, HotspotState::steady);
  EXPECT_EQ(history.between(1, 0).at(0).change.state, HotspotState::steady);
}

TEST_F(Histories, ChangesCountAgainstAllMissionsSinceTheLastOne) {
  HotspotHistory history;
  for (const double delta : {40.0, 41.0, 39.0, 40.0, 46.0, 47.0}) {
    fly({{kLeft, 30.0, 0.06}});
    Hotspot spot = history_.missions().back().hotspots.at(0);
    spot.delta = {delta, 1.0};
    history.add({"m", &layers_.back(), {spot}});
  }
  const auto& changes = history.tracks().at(0).changes;
  EXPECT_NEAR(changes[4]->from->value, 40.0, 1e-9);
  EXPECT_NEAR(changes[4]->from->sigma, 0.5, 1e-9);  // of four
  EXPECT_EQ(changes[4]->state, HotspotState::growing);
  EXPECT_NEAR(changes[5]->from->value, 46.0, 1e-9);
  EXPECT_EQ(changes[5]->state, HotspotState::steady);
}

TEST_F(Histories, WhatIsSeenOnlyFromTheSideIsNotGone) {
  fly({{kLeft, 30.0, 0.06}});
  // The next mission finds it cool, but by views that are 70 degrees off the surface's normal.
  std::vector<MappedReturn> returns = test::returnsOf({}, [](const Eigen::Vector3d&) { return 20.0; });
  for (MappedReturn& one : returns) one.temperature->incidence = 1.22F;
  const SurfaceLayer& layer = layers_.emplace_back(test::mapOf(returns));
  history_.add({"from the side", &layer, {}, {.focal_px = 5000.0, .blur_px = 0.1}});
  EXPECT_EQ(state(1, 1), HotspotState::not_observed);
  fly(std::vector<HotPeak>{});
  EXPECT_EQ(state(1, 2), HotspotState::gone);
}

TEST_F(Histories, WhatIsSeenTooFarAwayForItsSizeIsNotGone) {
  fly({{kLeft, 30.0, 0.06}});
  const SurfaceLayer& layer = layers_.emplace_back(
      test::mapOf(test::returnsOf({}, [](const Eigen::Vector3d&) { return 20.0; }, {.celsius = 0.1})));
  history_.add({"far", &layer, {}, {.focal_px = 20.0, .blur_px = 0.7}});  // a pixel is 15 cm
  EXPECT_EQ(state(1, 1), HotspotState::not_observed);
}

TEST_F(Histories, ASpotThatComesBackKeepsItsId) {
  fly({{kLeft, 30.0, 0.06}});
  fly([](const Eigen::Vector3d&) { return std::nan(""); });
  fly(std::vector<HotPeak>{});
  fly({{kLeft, 31.0, 0.06}});
  ASSERT_THAT(history_.tracks(), SizeIs(1));
  EXPECT_EQ(state(1, 1), HotspotState::not_observed);
  EXPECT_EQ(state(1, 2), HotspotState::gone);
  EXPECT_EQ(history_.tracks()[0].lastSeen(), 3U);
  // What was mended and is hot again is not what it was before.
  EXPECT_EQ(state(1, 3), HotspotState::fresh);
  EXPECT_TRUE(alarm(1, 3));
  EXPECT_NEAR(history_.tracks()[0].changes[3]->from->value, 0.0, 1.0);
  const auto back = history_.between(2, 3);
  ASSERT_THAT(back, SizeIs(1));
  EXPECT_EQ(back[0].change.state, HotspotState::fresh);
  EXPECT_TRUE(back[0].change.alarm);
}

TEST_F(Histories, ANewSpotWhereAllWasCoolAlarmsAndTakesTheNextId) {
  fly({{kLeft, 30.0, 0.06}});
  fly({{kLeft, 30.0, 0.06}, {kRight, 40.0, 0.06}});
  ASSERT_THAT(history_.tracks(), SizeIs(2));
  EXPECT_EQ(idAt(kLeft), 1);
  EXPECT_EQ(idAt(kRight), 2);  // hotter, but later
  EXPECT_EQ(state(2, 1), HotspotState::fresh);
  EXPECT_TRUE(alarm(2, 1));
  EXPECT_FALSE(history_.tracks()[1].changes[0]);
  const auto differences = history_.between(0, 1);
  ASSERT_THAT(differences, SizeIs(2));
  ASSERT_TRUE(differences[1].change.from);  // the first mission saw that it was cool there
  EXPECT_NEAR(differences[1].change.from->value, 0.0, 1.0);
  EXPECT_TRUE(differences[1].change.alarm);
}

TEST_F(Histories, MissionsThatLieOffTheTruthKeepTheIds) {
  fly([](const Eigen::Vector3d& p) {
    return 20.0 + test::riseAt({{kLeft, 30.0, 0.06}, {kRight, 30.0, 0.06}}, p);
  });
  fly(
      [](const Eigen::Vector3d& p) {
        return 20.0 + test::riseAt({{kLeft, 30.0, 0.06}, {kRight, 30.0, 0.06}}, p);
      },
      {0.03, -0.02, 0.01});
  ASSERT_THAT(history_.tracks(), SizeIs(2));
  for (const HotspotTrack& track : history_.tracks()) {
    EXPECT_NEAR(track.seen[0]->position.p_world.x(), track.seen[1]->position.p_world.x(), 0.05);
  }
  // 20 cm are no error that such covariances allow.
  fly(
      [](const Eigen::Vector3d& p) {
        return 20.0 + test::riseAt({{kLeft, 30.0, 0.06}, {kRight, 30.0, 0.06}}, p);
      },
      {0.0, 0.2, 0.0});
  EXPECT_THAT(history_.tracks(), SizeIs(4));
}

TEST_F(Histories, BetweenMissionsThatSawNeitherIsNothing) {
  fly(std::vector<HotPeak>{});
  fly(std::vector<HotPeak>{});
  fly({{kLeft, 30.0, 0.06}});
  EXPECT_THAT(history_.between(0, 1), IsEmpty());
  EXPECT_THAT(history_.between(0, 2), SizeIs(1));
  // Backwards it is the other way round.
  const auto backwards = history_.between(2, 0);
  ASSERT_THAT(backwards, SizeIs(1));
  EXPECT_EQ(backwards[0].change.state, HotspotState::gone);
  EXPECT_LT(backwards[0].change.change.value, -20.0);
}

TEST_F(Histories, LaterMissionsChangeNoIdOfEarlierOnes) {
  const std::vector<std::vector<HotPeak>> flights{
      {{kRight, 30.0, 0.06}},
      {{kLeft, 50.0, 0.06}, {kRight, 30.0, 0.06}},
      {{kLeft, 50.0, 0.06}, {kRight, 30.0, 0.06}, {{0.75, 0.2, 1.02}, 60.0, 0.06}}};
  std::vector<int> of_right, of_left;
  for (const auto& peaks : flights) {
    fly(peaks);
    of_right.push_back(idAt(kRight));
    of_left.push_back(idAt(kLeft));
  }
  EXPECT_THAT(of_right, testing::ElementsAre(1, 1, 1));
  EXPECT_THAT(of_left, testing::ElementsAre(0, 2, 2));
}

TEST(HotspotStates, HaveTheWordsOfTheReports) {
  EXPECT_STREQ(nameOf(HotspotState::fresh), "new");
  EXPECT_STREQ(nameOf(HotspotState::growing), "growing");
  EXPECT_STREQ(nameOf(HotspotState::steady), "steady");
  EXPECT_STREQ(nameOf(HotspotState::cooling), "cooling");
  EXPECT_STREQ(nameOf(HotspotState::gone), "gone");
  EXPECT_STREQ(nameOf(HotspotState::not_observed), "not_observed");
}

}  // namespace
}  // namespace thermovox
