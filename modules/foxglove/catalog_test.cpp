// SPDX-License-Identifier: Apache-2.0
#include "catalog.h"

#include <string>

#include <gtest/gtest.h>

namespace {

hc::GraphState some_state() {
  hc::GraphState state;
  state.modules.resize(2);
  state.modules[0].name = "eyes";
  state.modules[0].program = "camera";
  state.modules[0].parameters = {{"rate", "5"}};
  state.modules[1].name = "ball";
  state.modules[1].program = "blob";
  state.links.resize(1);
  state.links[0].from = "eyes.left";
  state.links[0].to = "ball.image";
  return state;
}

const hc::GraphState kState = some_state();

std::string camera() {
  hc::Description description;
  description.name = "camera";
  hc::PortType image;
  image.info.type = hc::MatrixType::RgbImage;
  image.info.components = 3;
  image.info.scalar = hc::Scalar::U8;
  description.outputs.push_back({"left", "", {image}, false});
  description.outputs.push_back({"any", "", {}, false});
  hc::ParameterState rate{"rate", "1/s", "", {}, 30.0, 30.0};
  description.parameters.push_back(rate);
  return hc::to_json(description);
}

TEST(Catalog, outputs_become_channels_once_they_are_described) {
  Catalog catalog(false);
  const auto first = catalog.take_state(kState);
  EXPECT_EQ(first.unknown, (std::vector<std::string>{"eyes", "ball"}));
  EXPECT_TRUE(first.added.empty());
  const auto described = catalog.describe("eyes", camera());
  ASSERT_EQ(described.added.size(), 2u);
  EXPECT_EQ(described.added[0].topic, "/eyes/left");
  EXPECT_EQ(described.added[0].type, hc::ros::Type::Image);
  EXPECT_EQ(described.added[1].type, hc::ros::Type::Matrix);
  const auto json = Json::parse(Catalog::advertise(described.added));
  EXPECT_EQ(json["op"], "advertise");
  EXPECT_EQ(json["channels"][0]["schemaName"], "sensor_msgs/msg/Image");
  EXPECT_EQ(json["channels"][0]["encoding"], "cdr");
  EXPECT_TRUE(catalog.take_state(kState).unknown.empty());
}

TEST(Catalog, images_may_be_jpeg) {
  Catalog catalog(true);
  catalog.take_state(kState);
  EXPECT_EQ(catalog.describe("eyes", camera()).added[0].type, hc::ros::Type::CompressedImage);
}

TEST(Catalog, a_module_that_leaves_takes_its_channels_with_it) {
  Catalog catalog(false);
  catalog.take_state(kState);
  const auto added = catalog.describe("eyes", camera()).added;
  const auto changes = catalog.take_state({});
  EXPECT_EQ(changes.removed, added);
  EXPECT_EQ(catalog.channels().size(), 2u);  // log and frames
  EXPECT_FALSE(catalog.has_parameter("eyes.rate"));
}

TEST(Catalog, parameters_are_numbers_and_change) {
  Catalog catalog(false);
  catalog.take_state(kState);
  catalog.describe("eyes", camera());
  auto values = Json::parse(catalog.parameter_values(catalog.parameter_names(), "x"));
  EXPECT_EQ(values["id"], "x");
  ASSERT_EQ(values["parameters"].size(), 1u);
  EXPECT_EQ(values["parameters"][0],
            (Json{{"name", "eyes.rate"}, {"value", 5.0}, {"type", "float64"}}));
  auto other = kState;
  other.modules[0].parameters["rate"] = "7";
  EXPECT_EQ(catalog.take_state(other).parameters, (std::vector<std::string>{"eyes.rate"}));
  EXPECT_TRUE(catalog.take_state(other).parameters.empty());
}

TEST(Catalog, values_that_were_just_set_count) {
  Catalog catalog(false);
  catalog.take_state(kState);
  catalog.describe("eyes", camera());
  const auto values = Json::parse(
      catalog.parameter_values({"eyes.rate", "eyes.rate", "eyes.none"}, "", {{"eyes.rate", "8"}}));
  ASSERT_EQ(values["parameters"].size(), 1u);
  EXPECT_EQ(values["parameters"][0]["value"], 8.0);
  EXPECT_EQ(Json::parse(catalog.parameter_values({}, "x"))["parameters"].size(), 0u);
}

TEST(Catalog, the_graph_says_who_publishes_and_takes) {
  Catalog catalog(false);
  EXPECT_TRUE(catalog.take_state(kState).graph);
  EXPECT_FALSE(catalog.take_state(kState).graph);
  const auto graph = Json::parse(catalog.connection_graph());
  EXPECT_EQ(graph["publishedTopics"], (Json{{{"name", "/eyes/left"}, {"publisherIds", {"eyes"}}}}));
  EXPECT_EQ(graph["subscribedTopics"],
            (Json{{{"name", "/eyes/left"}, {"subscriberIds", {"ball"}}}}));
}

}  // namespace
