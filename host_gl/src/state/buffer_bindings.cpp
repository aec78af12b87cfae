// SPDX-License-Identifier: MIT
// Buffer binding points, plain and indexed, and the assembly programs of ARB_vertex_program and ARB_fragment_program.
#include <array>
#include <tuple>

#include "state/writer.hpp"

namespace sluice::host::state {
namespace {

struct Row {
    const char* name;
    GLenum pname;
    Since since{};
};

constexpr std::array kBindings{
    Row{"GL_ARRAY_BUFFER_BINDING", GL_ARRAY_BUFFER_BINDING},
    Row{"GL_ELEMENT_ARRAY_BUFFER_BINDING", GL_ELEMENT_ARRAY_BUFFER_BINDING},
    Row{"GL_PIXEL_PACK_BUFFER_BINDING", GL_PIXEL_PACK_BUFFER_BINDING},
    Row{"GL_PIXEL_UNPACK_BUFFER_BINDING", GL_PIXEL_UNPACK_BUFFER_BINDING},
    Row{"GL_COPY_READ_BUFFER_BINDING", GL_COPY_READ_BUFFER_BINDING, {31, "GL_ARB_copy_buffer"}},
    Row{"GL_COPY_WRITE_BUFFER_BINDING", GL_COPY_WRITE_BUFFER_BINDING, {31, "GL_ARB_copy_buffer"}},
    Row{"GL_UNIFORM_BUFFER_BINDING", GL_UNIFORM_BUFFER_BINDING, {31, "GL_ARB_uniform_buffer_object"}},
    Row{"GL_TEXTURE_BUFFER_BINDING", GL_TEXTURE_BUFFER_BINDING, {44, nullptr}},
    Row{"GL_TRANSFORM_FEEDBACK_BUFFER_BINDING", GL_TRANSFORM_FEEDBACK_BUFFER_BINDING, {30, nullptr}},
    Row{"GL_DRAW_INDIRECT_BUFFER_BINDING", GL_DRAW_INDIRECT_BUFFER_BINDING, {40, "GL_ARB_draw_indirect"}},
    Row{"GL_DISPATCH_INDIRECT_BUFFER_BINDING", GL_DISPATCH_INDIRECT_BUFFER_BINDING, {43, "GL_ARB_compute_shader"}},
    Row{"GL_ATOMIC_COUNTER_BUFFER_BINDING", GL_ATOMIC_COUNTER_BUFFER_BINDING, {42, "GL_ARB_shader_atomic_counters"}},
    Row{"GL_SHADER_STORAGE_BUFFER_BINDING",
        GL_SHADER_STORAGE_BUFFER_BINDING,
        {43, "GL_ARB_shader_storage_buffer_object"}},
    Row{"GL_QUERY_BUFFER_BINDING", GL_QUERY_BUFFER_BINDING, {44, "GL_ARB_query_buffer_object"}},
};

struct Indexed {
    const char* name;
    GLenum most, binding, start, size;
    Since since{};
};

constexpr std::array kIndexed{
    Indexed{"uniform buffer ",
            GL_MAX_UNIFORM_BUFFER_BINDINGS,
            GL_UNIFORM_BUFFER_BINDING,
            GL_UNIFORM_BUFFER_START,
            GL_UNIFORM_BUFFER_SIZE,
            {31, "GL_ARB_uniform_buffer_object"}},
    Indexed{"transform feedback buffer ",
            GL_MAX_TRANSFORM_FEEDBACK_SEPARATE_ATTRIBS,
            GL_TRANSFORM_FEEDBACK_BUFFER_BINDING,
            GL_TRANSFORM_FEEDBACK_BUFFER_START,
            GL_TRANSFORM_FEEDBACK_BUFFER_SIZE,
            {30, nullptr}},
    Indexed{"atomic counter buffer ",
            GL_MAX_ATOMIC_COUNTER_BUFFER_BINDINGS,
            GL_ATOMIC_COUNTER_BUFFER_BINDING,
            GL_ATOMIC_COUNTER_BUFFER_START,
            GL_ATOMIC_COUNTER_BUFFER_SIZE,
            {42, "GL_ARB_shader_atomic_counters"}},
    Indexed{"shader storage buffer ",
            GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS,
            GL_SHADER_STORAGE_BUFFER_BINDING,
            GL_SHADER_STORAGE_BUFFER_START,
            GL_SHADER_STORAGE_BUFFER_SIZE,
            {43, "GL_ARB_shader_storage_buffer_object"}},
};

void writeAssemblyPrograms(Writer& writer) {
    for (const auto& [name, target, extension] :
         {std::tuple{"vertex program", GL_VERTEX_PROGRAM_ARB, "GL_ARB_vertex_program"},
          {"fragment program", GL_FRAGMENT_PROGRAM_ARB, "GL_ARB_fragment_program"}}) {
        if (epoxy_has_gl_extension(extension)) {
            GLint program = 0;
            glGetProgramivARB(static_cast<GLenum>(target), GL_PROGRAM_BINDING_ARB, &program);
            writer.put(member(name, "binding"), integersText(&program, 1, Kind::Integer));
        }
    }
}

}  // namespace

void writeBufferBindings(Writer& writer) {
    for (const Row& row : kBindings) {
        if (available(row.since)) {
            writer.query(row.name, row.pname, Kind::Integer);
        }
    }
    for (const Indexed& row : kIndexed) {
        if (!available(row.since)) {
            continue;
        }
        const int count = queryInteger(row.most);
        for (int i = 0; i < count; ++i) {
            const auto index = static_cast<GLuint>(i);
            GLint binding = 0;
            glGetIntegeri_v(row.binding, index, &binding);
            std::array<GLint64, 2> range{};
            glGetInteger64i_v(row.start, index, &range[0]);
            glGetInteger64i_v(row.size, index, &range[1]);
            // One line: a binding and its range change together.
            writer.put(numbered(row.name, i), integersText(&binding, 1, Kind::Integer) + " from " +
                                                  std::to_string(range[0]) + " size " + std::to_string(range[1]));
        }
    }
    writeAssemblyPrograms(writer);
}

}  // namespace sluice::host::state
