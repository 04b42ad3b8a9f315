// SPDX-License-Identifier: Apache-2.0
/// Loading takes time in proportion to what is loaded, whatever there is many of. What is quadratic
/// takes 20 s and more for these numbers; the bound leaves room for sanitizers.

#include <ctime>

#include "load_urdf.hpp"
#include "sample_urdf.hpp"

namespace softgauss::io {
namespace {

constexpr int kMany = 30000;
constexpr double kMost = 5.0;  ///< [s] of processor time

/// The time that `work` takes of the processor [s].
template <class Work>
double timeOf(const Work& work) {
  const std::clock_t begin = std::clock();
  work();
  return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

template <class Text>
std::string many(const Text& text) {
  std::string all;
  for (int i = 0; i < kMany; ++i) all += text(std::to_string(i));
  return all;
}

/// tinyxml2 compares each attribute of an element with all others.
TEST(UrdfScale, Attributes) {
  const std::string attributes = many([](const std::string& i) { return " a" + i + "='<'"; });
  EXPECT_LT(timeOf([&] {
              try {
                load(with(kSampleUrdf, "<axis", "<axis" + attributes));
                ADD_FAILURE() << "no error";
              } catch (const ModelError& error) {
                EXPECT_NE(std::string(error.what())
                              .find("robot.urdf:21: XML: an element has more than 250 attributes"),
                          std::string::npos)
                    << error.what();
              }
            }),
            kMost);
  // They are counted where they are, not in comments, in text or over several elements.
  const std::string elements = many([](const std::string&) { return "<x a='1' b=\"2'>\"/>"; });
  EXPECT_NO_THROW(load(with(kSampleUrdf, "</robot>",
                            "<!-- <a" + attributes + "> --><y>" + std::string(1000, '"') +
                                "</y><![CDATA[<z" + attributes + "]]>" + elements + "</robot>")));
}

/// The sample with links fixed one to the other, names ascending or descending.
std::string chain(bool ascending) {
  const auto name = [&](int i) { return "l" + std::to_string(ascending ? i : 1000000 - i); };
  std::string text;
  for (int i = 0; i < kMany; ++i)
    text += "<link name='" + name(i) + "'/><joint name='j" + std::to_string(i) +
            "' type='fixed'><parent link='" + (i == 0 ? "arm" : name(i - 1)) + "'/><child link='" +
            name(i) + "'/></joint>";
  return with(kSampleUrdf, "</robot>", text + "</robot>");
}

// urdfdom frees a link after those that own it: in one order of names as many calls are nested.
TEST(UrdfScale, FixedLinksInAChain) {
  for (const bool ascending : {true, false})
    EXPECT_LT(timeOf([&] { EXPECT_EQ(load(chain(ascending)).frames.size(), kMany + 2u); }), kMost);
}

TEST(UrdfScale, FixedLinksOnOne) {
  const std::string text = many([](const std::string& i) {
    return "<link name='l" + i + "'/><joint name='j" + i +
           "' type='fixed'><parent link='arm'/><child link='l" + i + "'/></joint>";
  });
  EXPECT_LT(timeOf([&] { load(with(kSampleUrdf, "</robot>", text + "</robot>")); }), kMost);
}

TEST(UrdfScale, ShapesOnOneLink) {
  // Beads along y, of which every other one might cap a rod.
  const std::string text = many([](const std::string& i) {
    return "<collision><origin xyz='0 " + i +
           " 0'/><geometry><sphere radius='0.1'/></geometry>"
           "</collision><collision><origin xyz='0 " +
           i + " 0'/><geometry><cylinder radius='0.1' length='0.5'/></geometry></collision>";
  });
  EXPECT_LT(timeOf([&] {
              EXPECT_EQ(load(with(kSampleUrdf, "<link name=\"arm\">", "<link name=\"arm\">" + text))
                            .geometries.size(),
                        2u * kMany + 2u);
            }),
            kMost);
}

TEST(UrdfScale, NamesThatDoNotExist) {
  const std::string text = many([](const std::string& i) { return "<link name='l" + i + "'/>"; });
  EXPECT_LT(timeOf([&] {
              EXPECT_THROW(load(with(with(kSampleUrdf, "child link=\"arm\"", "child link=\"aim\""),
                                     "</robot>", text + "</robot>")),
                           ModelError);
            }),
            kMost);
}

}  // namespace
}  // namespace softgauss::io
