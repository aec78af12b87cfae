// SPDX-License-Identifier: MIT
// The shared library as a host sees it: one symbol, no way in but the ABI.
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "sluice/plugin.h"

namespace {

struct Library {
    void* handle = ::dlopen(SLUICE_PLUGIN_PATH, RTLD_NOW | RTLD_LOCAL);
    Library() = default;
    Library(const Library&) = delete;
    Library& operator=(const Library&) = delete;
    ~Library() {
        if (handle != nullptr) {
            ::dlclose(handle);
        }
    }
};

TEST(Plugin, ExportsTheEntryAndNothingElse) {
    const Library library;
    ASSERT_NE(library.handle, nullptr) << ::dlerror();
    EXPECT_NE(::dlsym(library.handle, SLUICE_RENDERER_ENTRY_SYMBOL), nullptr);
    // volk's loader and its function pointers: a host may have its own.
    EXPECT_EQ(::dlsym(library.handle, "volkInitialize"), nullptr);
    EXPECT_EQ(::dlsym(library.handle, "vkCreateDevice"), nullptr);
}

TEST(Plugin, ServesItsMajorOnly) {
    const Library library;
    ASSERT_NE(library.handle, nullptr) << ::dlerror();
    const auto entry = reinterpret_cast<SluiceRendererEntry>(::dlsym(library.handle, SLUICE_RENDERER_ENTRY_SYMBOL));
    ASSERT_NE(entry, nullptr);
    EXPECT_EQ(entry(SLUICE_MAKE_ABI(SLUICE_ABI_MAJOR + 1, 0)), nullptr);
    EXPECT_EQ(entry(SLUICE_MAKE_ABI(0, 9)), nullptr);
    EXPECT_NE(entry(SLUICE_MAKE_ABI(SLUICE_ABI_MAJOR, 7)), nullptr) << "a newer minor uses what both know";
    const SluiceRendererApi* api = entry(SLUICE_ABI_VERSION);
    ASSERT_NE(api, nullptr);
    EXPECT_EQ(api->struct_size, sizeof(SluiceRendererApi));
    EXPECT_EQ(api->abi_version, SLUICE_ABI_VERSION);
    EXPECT_STREQ(api->name, "sluice-renderer-vk");
    EXPECT_NE(api->version, nullptr);
    EXPECT_TRUE(api->describe && api->explain && api->create && api->info && api->resize && api->set_particles &&
                api->set_environment && api->submit_frame && api->poll && api->timeline_signal && api->timeline_wait &&
                api->timeline_value && api->timeline_export && api->probe_format && api->destroy);
}

TEST(Plugin, ExplainsWithoutADevice) {
    const Library library;
    ASSERT_NE(library.handle, nullptr) << ::dlerror();
    const auto entry = reinterpret_cast<SluiceRendererEntry>(::dlsym(library.handle, SLUICE_RENDERER_ENTRY_SYMBOL));
    ASSERT_NE(entry, nullptr);
    SluiceSceneNeeds needs{};
    needs.struct_size = sizeof(needs);
    needs.width = 1280;
    needs.height = 720;
    needs.particle_count = 1000;
    needs.fluid.index_of_refraction = 1.33F;
    needs.fluid.specular_power = 100.0F;
    needs.fluid.splat_radius = 1.5F;
    needs.fluid.thickness_scale = 0.5F;
    std::vector<std::string> lines;
    const auto sink = [](void* user, const char* line) {
        static_cast<std::vector<std::string>*>(user)->emplace_back(line);
    };
    SluiceError error{};
    error.struct_size = sizeof(error);
    ASSERT_EQ(entry(SLUICE_ABI_VERSION)->explain(&needs, sink, &lines, &error), SLUICE_OK) << error.message;
    EXPECT_GE(lines.size(), 3U);
    needs.width = 0;
    EXPECT_EQ(entry(SLUICE_ABI_VERSION)->explain(&needs, sink, &lines, &error), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_NE(error.message[0], '\0');
}

}  // namespace
