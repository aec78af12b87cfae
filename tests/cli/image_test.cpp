// SPDX-License-Identifier: MIT
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "image/atomic_file.hpp"
#include "image/colour.hpp"
#include "image/depth_layer.hpp"
#include "image/environment.hpp"
#include "image/exr.hpp"
#include "image/layers.hpp"
#include "image/png.hpp"

namespace sluice::cli {
namespace {

std::filesystem::path temporary(const std::string& name) {
    return std::filesystem::path(::testing::TempDir()) / name;
}

TEST(Colour, DecodesSrgb) {
    EXPECT_EQ(srgbToLinear(0.0F), 0.0F);
    EXPECT_NEAR(srgbToLinear(1.0F), 1.0F, 1e-6F);
    EXPECT_NEAR(srgbToLinear(0.5F), 0.214041F, 1e-5F);
    EXPECT_NEAR(srgbToLinear(0.04045F), 0.04045F / 12.92F, 1e-6F);
}

TEST(Colour, LinearDepthInvertsThePerspective) {
    EXPECT_FLOAT_EQ(linearDepth(0.0F, 0.1F, 60.0F), 0.1F);
    EXPECT_TRUE(std::isinf(linearDepth(1.0F, 0.1F, 60.0F)));
    for (const double metres : {0.2, 1.0, 5.0, 20.0}) {
        const double near = 0.1;
        const double far = 60.0;
        const double window = (1.0 / near - 1.0 / metres) / (1.0 / near - 1.0 / far);
        EXPECT_NEAR(static_cast<double>(linearDepth(static_cast<float>(window), 0.1F, 60.0F)), metres,
                    metres * metres * 1e-6 + 1e-6);
    }
}

TEST(Png, KeepsEveryByteAndDropsAlpha) {
    const host::Pixels pixels{3, 2, 4, {0.0F,  1.0F, 0.5F, 0.2F, 10 / 255.0F,  20 / 255.0F,  30 / 255.0F,  1.0F,
                                        -1.0F, 2.0F, 0.0F, 0.0F, 1.0F,         1.0F,         1.0F,         1.0F,
                                        0.0F,  0.0F, 0.0F, 0.0F, 250 / 255.0F, 251 / 255.0F, 252 / 255.0F, 0.0F}};
    const auto path = temporary("sluice-png-test.png");
    ASSERT_TRUE(writePng(path, pixels).ok());
    const auto input = OIIO::ImageInput::open(path.string());
    ASSERT_TRUE(input);
    ASSERT_EQ(input->spec().nchannels, 3);
    std::vector<unsigned char> bytes(18);
    ASSERT_TRUE(input->read_image(0, 0, 0, 3, OIIO::TypeDesc::UINT8, bytes.data()));
    const std::vector<unsigned char> expected{0,   255, 128, 10, 20, 30, 0,   255, 0,
                                              255, 255, 255, 0,  0,  0,  250, 251, 252};
    EXPECT_EQ(bytes, expected);
    std::filesystem::remove(path);
}

TEST(Exr, KeepsNamesTypesAndInfinity) {
    const float inf = std::numeric_limits<float>::infinity();
    const LayeredImage image{2, 1, {{"R", true, {0.5F, 0.25F}}, {"host.Z", false, {1.2345678F, inf}}}};
    const auto path = temporary("sluice-exr-test.exr");
    ASSERT_TRUE(writeExr(path, image).ok());
    const auto input = OIIO::ImageInput::open(path.string());
    ASSERT_TRUE(input);
    const OIIO::ImageSpec spec = input->spec();
    const int r = spec.channelindex("R");
    const int z = spec.channelindex("host.Z");
    ASSERT_TRUE(r >= 0 && z >= 0);
    EXPECT_EQ(spec.channelformat(r), OIIO::TypeDesc::HALF);
    EXPECT_EQ(spec.channelformat(z), OIIO::TypeDesc::FLOAT);
    std::vector<float> values(4);
    ASSERT_TRUE(input->read_image(0, 0, 0, 2, OIIO::TypeDesc::FLOAT, values.data()));
    EXPECT_EQ(values[static_cast<std::size_t>(r)], 0.5F);
    EXPECT_EQ(values[static_cast<std::size_t>(z)], 1.2345678F);
    EXPECT_EQ(values[static_cast<std::size_t>(2 + z)], inf);
    std::filesystem::remove(path);
}

TEST(DepthLayer, IsReadWithTheCameraThatTheFileHasAndWhatItLacksIsNamed) {
    const float inf = std::numeric_limits<float>::infinity();
    LayeredImage image{2, 2, {{"A", true, {1, 1, 1, 1}}, {"host.Z", false, {1, 2, 3, inf}}}};
    ImageCamera& camera = image.camera.emplace();
    for (std::size_t i = 0; i < 16; ++i) {
        camera.view.at(i) = static_cast<float>(i);
        camera.projection.at(i) = -static_cast<float>(i);
    }
    camera.near_plane = 0.25F;
    const auto path = temporary("sluice-depth-test.exr");
    ASSERT_TRUE(writeExr(path, image).ok());
    const auto layer = readDepthLayer(path);
    ASSERT_TRUE(layer) << layer.error().message();
    EXPECT_EQ(layer.value().width, 2U);
    EXPECT_EQ(layer.value().depth, (std::vector<float>{3, inf, 1, 2})) << "bottom row first";
    ASSERT_TRUE(layer.value().camera);
    EXPECT_EQ(layer.value().camera->view, camera.view);
    EXPECT_EQ(layer.value().camera->projection, camera.projection);
    EXPECT_EQ(layer.value().camera->near_plane, 0.25F);
    EXPECT_TRUE(readDepthLayer(path, false).value().depth.empty());
    const auto refusal = [&](const LayeredImage& other) {
        EXPECT_TRUE(writeExr(path, other).ok());
        const auto read = readDepthLayer(path);
        return read ? std::string() : read.error().message();
    };
    // Another program's, which says nothing of the camera that we could trust.
    LayeredImage plain{2, 2, {{"Z", false, {4, 5, 6, 7}}}};
    ASSERT_EQ(refusal(plain), "");
    EXPECT_FALSE(readDepthLayer(path).value().camera);
    EXPECT_EQ(readDepthLayer(path).value().depth[0], 6.0F);
    camera.near_plane = 0.0F;
    EXPECT_NE(refusal(image).find("says in part which camera it is of"), std::string::npos);
    plain.channels[0].name = "R";
    EXPECT_NE(refusal(plain).find("has no channel host.Z, nor Z"), std::string::npos);
    std::filesystem::remove(path);
    EXPECT_NE(readDepthLayer(path).error().message().find("No such file"), std::string::npos);
    EXPECT_NE(readDepthLayer(path.parent_path()).error().message().find("a regular file"), std::string::npos);
}

TEST(Layers, PremultiplyFluidAndLeaveOutWhatIsNotThere) {
    FrameLayers layers;
    layers.beauty = {1, 1, 4, {1.0F, 1.0F, 1.0F, 0.0F}};
    EXPECT_EQ(layeredImage(layers, 0.1F, 60.0F).channels.size(), 4U);
    layers.fluid_colour = host::Pixels{1, 1, 4, {1.0F, 0.0F, 0.5F, 0.25F}};
    const LayeredImage image = layeredImage(layers, 0.1F, 60.0F);
    ASSERT_EQ(image.channels.size(), 8U);
    EXPECT_EQ(image.channels[3].values[0], 1.0F);  // opaque, whatever the back buffer's alpha holds
    EXPECT_EQ(image.channels[4].name, "fluid.R");
    EXPECT_NEAR(image.channels[4].values[0], 0.25F, 1e-6F);
    EXPECT_NEAR(image.channels[6].values[0], 0.214041F * 0.25F, 1e-5F);
    EXPECT_EQ(image.channels[7].values[0], 0.25F);
}

std::filesystem::path writeMap(const std::string& name, const OIIO::TypeDesc& type, const std::vector<float>& pixels) {
    auto path = temporary(name);
    const auto output = OIIO::ImageOutput::create(path.string());
    const OIIO::ImageSpec spec(2, 1, 3, type);
    EXPECT_TRUE(output && output->open(path.string(), spec) &&
                output->write_image(OIIO::TypeDesc::FLOAT, pixels.data()) && output->close());
    return path;
}

TEST(EnvironmentMap, FloatIsLinearAndBytesAreDecoded) {
    const std::vector<float> pixels{0.0F, 0.5F, 1.0F, 1.0F, 1.0F, 0.0F};
    const auto exr = loadEnvironment(writeMap("sluice-env.exr", OIIO::TypeDesc::HALF, pixels));
    ASSERT_TRUE(exr.ok());
    EXPECT_EQ(exr.value().width, 2U);
    EXPECT_EQ(exr.value().pixels, pixels);
    const auto png = loadEnvironment(writeMap("sluice-env.png", OIIO::TypeDesc::UINT8, pixels));
    ASSERT_TRUE(png.ok());
    EXPECT_NEAR(png.value().pixels[1], srgbToLinear(128 / 255.0F), 1e-5F);
}

TEST(EnvironmentMap, BadFilesAreNamed) {
    const auto path = temporary("sluice-env-bad.exr");
    ASSERT_TRUE(writeTextFile(path, "no image").ok());
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const auto poisoned = writeMap("sluice-env-nan.exr", OIIO::TypeDesc::FLOAT, {0, 0, 0, 0, nan, 0});
    for (const auto& bad : {path, poisoned, temporary("sluice-env-missing.exr")}) {
        const auto map = loadEnvironment(bad);
        ASSERT_FALSE(map.ok()) << bad;
        EXPECT_EQ(map.error().code, SLUICE_ERROR_INVALID_ARGUMENT);
        EXPECT_NE(map.error().message().find(bad.string()), std::string::npos);
    }
    EXPECT_NE(loadEnvironment(poisoned).error().detail.find("pixel (1, 0)"), std::string::npos);
}

}  // namespace
}  // namespace sluice::cli
