// SPDX-License-Identifier: Apache-2.0
/// The comparison finds a difference where there is one, and none in what is only in another order.

#include "tests/parity/comparison.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "tests/parity/reference_scene.hpp"
#include "tests/support/sample_models.hpp"

namespace softgauss::test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Row row(double j, double D, double reference, double force) {
  return {Eigen::Vector2d(j, 1.0), D, reference, force};
}

TEST(Comparison, RowsInAnotherOrderAreTheSame) {
  const std::vector<Row> reference = {row(1, 2, 3, 4), row(1, 2, -3, 5), row(-1, 2, 3, 6)};
  const RowDifference d = compareRows({reference[2], reference[0], reference[1]}, reference, 0);
  EXPECT_FALSE(d.unmatched);
  EXPECT_EQ(d.J + d.D + d.reference + d.force, 0.0);
}

TEST(Comparison, FindsEveryDifferenceOfARow) {
  const std::vector<Row> reference = {row(1, 2, 30, 4)};
  EXPECT_NEAR(compareRows({row(1.1, 2, 30, 4)}, reference, 1).J, 0.1 / 1.0, 1e-15);
  EXPECT_NEAR(compareRows({row(1, 2.2, 30, 4)}, reference, 1).D, 0.1, 1e-15);
  EXPECT_NEAR(compareRows({row(1, 2, 33, 4)}, reference, 1).reference, 0.1, 1e-15);
  EXPECT_NEAR(compareRows({row(1, 2, 30, 5)}, reference, 1).force, 0.25, 1e-15);
  EXPECT_TRUE(compareRows({}, reference, 1).unmatched);
  EXPECT_TRUE(compareRows({row(kNaN, 2, 30, 4)}, reference, 1).unmatched);
}

TEST(Comparison, ContactsMayNameTheirGeometriesInEitherOrder) {
  const Model model = boxOnPlane({0.1, 0.1, 0.1}, 1.0, 0.5).build();
  ASSERT_EQ(model.geometries.size(), 2u);
  Contact contact;
  contact.geometryA = 0;
  contact.geometryB = 1;
  contact.p_WC = Vector3(1, 2, 3);
  contact.distance = -0.5;
  ContactSet ours;
  ours.add(contact);

  ReferenceContact theirs;
  theirs.geometries[0] = model.geometries[1].name;
  theirs.geometries[1] = model.geometries[0].name;
  theirs.position = contact.p_WC + Vector3(0, 1e-3, 0);
  theirs.normal = -contact.n_W;
  theirs.distance = -0.75;
  const ContactDifference d = compareContacts(model, ours, {theirs});
  EXPECT_FALSE(d.unmatched);
  EXPECT_NEAR(d.position, 1e-3, 1e-15);
  EXPECT_EQ(d.normal, 0.0);
  EXPECT_EQ(d.distance, 0.25);

  // The same as a source of contacts.
  ours.contacts = loggedContacts(model, {theirs});
  const ContactDifference same = compareContacts(model, ours, {theirs});
  EXPECT_FALSE(same.unmatched);
  EXPECT_EQ(same.position + same.normal + same.distance, 0.0);

  theirs.geometries[0] = "another";
  EXPECT_THROW(loggedContacts(model, {theirs}), std::runtime_error);
  EXPECT_TRUE(compareContacts(model, ours, {theirs}).unmatched);
  EXPECT_TRUE(compareContacts(model, ours, {}).unmatched);
}

TEST(Comparison, OfVectorsSeesSizesAndNaN) {
  EXPECT_EQ(relativeDifference(Eigen::Vector2d(1, 20), Eigen::Vector2d(1, 10), 0), 1.0);
  EXPECT_EQ(relativeDifference(Eigen::Vector2d(1, 20), Eigen::Vector2d(1, 10), 20), 0.5);
  EXPECT_EQ(relativeDifference(Eigen::Vector2d(0, 0), Vector3(0, 0, 0), 1), kInfinity);
  EXPECT_TRUE(std::isnan(relativeDifference(Eigen::Vector2d(kNaN, 0), Eigen::Vector2d(0, 0), 1)));
}

TEST(ReferenceScene, RefusesWhatItDoesNotKnow) {
  nlohmann::json scene = {{"links", {{{"name", "a"}, {"colour", "red"}}}},
                          {"joints", nlohmann::json::array()},
                          {"geometries", nlohmann::json::array()},
                          {"equalities", nlohmann::json::array()}};
  const nlohmann::json options = {
      {"timestep", 0.002}, {"gravity", {0, 0, 0}}, {"cone", "pyramidal"}, {"impratio", 1}};
  EXPECT_THROW(referenceModel("a", scene, options), std::runtime_error);
  scene["links"][0].erase("colour");
  EXPECT_EQ(referenceModel("a", scene, options).nv, 0);
}

}  // namespace
}  // namespace softgauss::test
