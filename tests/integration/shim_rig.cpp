// SPDX-License-Identifier: MIT
#include "shim_rig.hpp"

#include <dlfcn.h>

#include <memory>

namespace sluice::host::test {

void ShimTest::SetUp() {
    ASSERT_NO_FATAL_FAILURE(EchoTest::SetUp());
    Result<PluginLibrary> library = PluginLibrary::load(SLUICE_SHIM_RENDERER);
    ASSERT_TRUE(library) << library.error().message();
    library_.emplace(std::move(library).value());
    void* handle = dlopen(SLUICE_SHIM_RENDERER, RTLD_NOW | RTLD_NOLOAD);
    ASSERT_NE(handle, nullptr);
    control_ = static_cast<ShimControl*>(dlsym(handle, kShimControlSymbol));
    dlclose(handle);  // library_ still holds it
    ASSERT_NE(control_, nullptr);
    resetShim();
}

void ShimTest::resetShim() const {
    std::destroy_at(control_);
    std::construct_at(control_);
}

}  // namespace sluice::host::test
