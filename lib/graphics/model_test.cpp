// SPDX-License-Identifier: Apache-2.0
#include <graphics/model.h>

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>

#include <opencv2/imgcodecs.hpp>

#include <hc/testing/files.h>

namespace hc::graphics {
namespace {

struct Models : testing::Test {
  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(folder / name) << text;
    return folder / name;
  }

  Folder folder;
};

constexpr const char* kSquare =
    "mtllib square.mtl\nv 0 0 0\nv 2 0 0\nv 2 3 0\nv 0 3 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
    "usemtl paint\nf 1/1 2/2 3/3 4/4\n";

TEST_F(Models, a_file_gives_its_triangles_and_colours) {
  write("square.mtl", "newmtl paint\nKd 1.0 0.5 0.0\n");
  auto parts = read_model(write("square.obj", kSquare));
  ASSERT_TRUE(parts) << parts.error().text();
  ASSERT_EQ(parts->size(), 1U);
  const Part& part = parts->front();
  EXPECT_EQ(part.mesh.indices.size(), 6U);
  EXPECT_EQ(part.texture.at<cv::Vec3b>(0, 0), cv::Vec3b(255, 128, 0));
  for (const auto& vertex : part.mesh.vertices) {
    EXPECT_EQ(vertex.normal, Eigen::Vector3f(0, 0, 1));
    // Files count texture rows from the bottom, images from the top.
    EXPECT_FLOAT_EQ(vertex.texture.y(), 1 - vertex.position.y() / 3);
  }
}

TEST_F(Models, a_texture_lies_beside_the_file) {
  cv::imwrite(folder / "blue.png", cv::Mat(4, 4, CV_8UC3, cv::Scalar(255, 0, 0)));
  write("square.mtl", "newmtl paint\nmap_Kd blue.png\n");
  auto parts = read_model(write("square.obj", kSquare));
  ASSERT_TRUE(parts) << parts.error().text();
  EXPECT_EQ(parts->front().texture.at<cv::Vec3b>(0, 0), cv::Vec3b(0, 0, 255));
  write("square.mtl", "newmtl paint\nmap_Kd none.png\n");
  parts = read_model(folder / "square.obj");
  ASSERT_FALSE(parts);
  EXPECT_NE(parts.error().detail.find("none.png: not an image"), std::string::npos);
}

TEST_F(Models, a_texture_may_be_named_as_on_windows_or_in_a_uri) {
  std::filesystem::create_directory(folder / "my paint");
  cv::imwrite(folder / "my paint/blue.png", cv::Mat(4, 4, CV_8UC3, cv::Scalar(255, 0, 0)));
  for (const std::string name : {"my paint\\blue.png", "my%20paint/blue.png"}) {
    write("square.mtl", "newmtl paint\nmap_Kd " + name + "\n");
    auto parts = read_model(write("square.obj", kSquare));
    ASSERT_TRUE(parts) << parts.error().text();
    EXPECT_EQ(parts->front().texture.at<cv::Vec3b>(0, 0), cv::Vec3b(0, 0, 255)) << name;
  }
  cv::imwrite(folder / "100%25.png", cv::Mat(4, 4, CV_8UC3, cv::Scalar(0, 255, 0)));
  write("square.mtl", "newmtl paint\nmap_Kd 100%25.png\n");
  EXPECT_TRUE(read_model(folder / "square.obj")) << "a file of this very name";
}

TEST_F(Models, the_folder_of_a_model_is_taken_as_it_is) {
  std::filesystem::create_directories(folder / "100%25 blue/my paint");
  cv::imwrite(folder / "100%25 blue/my paint/blue.png", cv::Mat(4, 4, CV_8UC3, cv::Scalar::all(9)));
  write("100%25 blue/square.mtl", "newmtl paint\nmap_Kd my%20paint/blue.png\n");
  const auto parts = read_model(write("100%25 blue/square.obj", kSquare));
  EXPECT_TRUE(parts) << parts.error().text();
}

TEST_F(Models, an_ending_may_be_in_capitals) {
  write("square.mtl", "newmtl paint\n");
  EXPECT_TRUE(read_model(write("SQUARE.OBJ", kSquare)));
}

TEST_F(Models, the_sides_of_an_stl_are_flat) {
  auto parts = read_model(write("side.stl",
                                "solid s\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\n"
                                "vertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid s\n"));
  ASSERT_TRUE(parts) << parts.error().text();
  for (const auto& vertex : parts->front().mesh.vertices)
    EXPECT_EQ(vertex.normal, Eigen::Vector3f(0, 0, 1));
}

TEST_F(Models, wrong_normals_are_replaced) {
  const auto parts =
      read_model(write("side.obj",
                       "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 0\nvn nan nan nan\nvn 0 0.6 0.8\n"
                       "f 1//1 2//2 3//3\n"));
  ASSERT_TRUE(parts) << parts.error().text();
  for (const auto& vertex : parts->front().mesh.vertices)
    EXPECT_TRUE(vertex.normal.isApprox(vertex.position.y() == 0 ? Eigen::Vector3f(0, 0, 1)
                                                                : Eigen::Vector3f(0, 0.6F, 0.8F)))
        << vertex.position.transpose();
}

TEST_F(Models, vertices_have_colours) {
  auto parts =
      read_model(write("rgb.obj", "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 0.5\nf 1 2 3\n"));
  ASSERT_TRUE(parts) << parts.error().text();
  EXPECT_EQ(parts->front().mesh.vertices.at(2).colour, Eigen::Vector3f(0, 0, 0.5));
  EXPECT_EQ(parts->front().texture.at<cv::Vec3b>(0, 0), cv::Vec3b(255, 255, 255));
}

/// A glTF of one triangle, whose positions are little-endian floats.
std::string gltf(const std::string& buffer) {
  return R"({"asset": {"version": "2.0"}, "scene": 0,
 "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
 "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [0.2, 1, 0, 1]}}],
 "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
 "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                "min": [0, 0, 0], "max": [1, 1, 0]}],
 "bufferViews": [{"buffer": 0, "byteLength": 36}],
 "buffers": [{"byteLength": 36, "uri": ")" +
         buffer + "\"}]}";
}

TEST_F(Models, colours_of_gltf_are_linear) {
  const auto parts =
      read_model(write("grey.gltf", gltf("data:application/octet-stream;base64,"
                                         "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA")));
  ASSERT_TRUE(parts) << parts.error().text();
  EXPECT_EQ(parts->front().texture.at<cv::Vec3b>(0, 0), cv::Vec3b(124, 255, 0));
}

TEST_F(Models, a_buffer_of_gltf_is_named_as_in_a_uri) {
  constexpr std::array<float, 9> kTriangle{0, 0, 0, 1, 0, 0, 0, 1, 0};
  write("my buffer.bin", {reinterpret_cast<const char*>(kTriangle.data()), sizeof kTriangle});
  const auto parts = read_model(write("triangle.gltf", gltf("my%20buffer.bin")));
  ASSERT_TRUE(parts) << parts.error().text();
  std::filesystem::create_directory(folder / "100%25");
  std::filesystem::copy(folder / "my buffer.bin", folder / "100%25/my buffer.bin");
  EXPECT_TRUE(read_model(write("100%25/triangle.gltf", gltf("my%20buffer.bin"))));
  EXPECT_EQ(parts->front().mesh.indices.size(), 3U);
}

TEST_F(Models, a_damaged_texture_is_refused) {
  cv::Mat noise(64, 64, CV_8UC3);
  cv::randu(noise, 0, 255);
  write("m.mtl", "newmtl skin\nmap_Kd skin.image\n");
  const auto model = write("m.obj",
                           "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\n"
                           "vt 0 1\nusemtl skin\nf 1/1 2/2 3/3\n");
  for (const char* ending : {".jpg", ".png"}) {
    std::vector<std::uint8_t> file;
    ASSERT_TRUE(cv::imencode(ending, noise, file));
    const std::string whole(file.begin(), file.end());
    write("skin.image", whole);
    EXPECT_TRUE(read_model(model)) << ending;
    for (const auto size : {whole.size() / 2, whole.size() - 40, std::size_t{1}, std::size_t{0}}) {
      write("skin.image", whole.substr(0, size));
      const auto cut = read_model(model);
      ASSERT_FALSE(cut) << ending << " " << size;
      EXPECT_EQ(cut.error().code, Code::Malformed);
      EXPECT_NE(cut.error().detail.find("skin.image: "), std::string::npos);
    }
  }
}

TEST_F(Models, what_is_no_model_is_refused) {
  EXPECT_EQ(read_model(folder / "none.obj").error().code, Code::NotFound);
  EXPECT_EQ(read_model(folder.path()).error().code, Code::NotFound);
  for (const auto& [name, text] : std::vector<std::pair<std::string, std::string>>{
           {"empty.obj", ""},
           {"points.obj", "v 0 0 0\nv 1 0 0\np 1 2\n"},
           {"wild.obj", "v 0 0 0\nf 1 2 99999999\n"},
           {"empty.glb", "glTF"},
           {"void.gltf", R"({"asset": {"version": "2.0"}, "meshes": [{"primitives": [{}]}]})"},
           {"noise.stl", std::string(200, '\xff')},
           {"cut.obj", "v 0 0 0\nv 1 0"}}) {
    auto parts = read_model(write(name, text));
    ASSERT_FALSE(parts) << name;
    EXPECT_EQ(parts.error().code, Code::Malformed) << name;
    EXPECT_EQ(parts.error().detail.find('\n'), std::string::npos) << parts.error().detail;
  }
  // assimp would take hours for the vertices that this file claims but lacks.
  EXPECT_EQ(read_model(write("cut.ply",
                             "ply\nformat binary_little_endian 1.0\nelement vertex "
                             "4000000000\nproperty float x\nend_header\n"))
                .error()
                .code,
            Code::Unsupported);
}

}  // namespace
}  // namespace hc::graphics
