// SPDX-License-Identifier: MIT
#include "state_changes.hpp"

#include <array>

namespace sluice::host::test {
namespace {

/// No state has these values by default.
constexpr std::array<GLfloat, 4> kVector{0.1F, 0.2F, 0.3F, 0.4F};

constexpr std::array kChanges{
    StateChange{"AlphaTest", "GL_ALPHA_TEST", [](const SpareObjects&) { glEnable(GL_ALPHA_TEST); }},
    StateChange{"AutoNormal", "GL_AUTO_NORMAL", [](const SpareObjects&) { glEnable(GL_AUTO_NORMAL); }},
    StateChange{"Blend", "GL_BLEND", [](const SpareObjects&) { glEnable(GL_BLEND); }},
    StateChange{"ColorLogicOp", "GL_COLOR_LOGIC_OP", [](const SpareObjects&) { glEnable(GL_COLOR_LOGIC_OP); }},
    StateChange{"ColorSum", "GL_COLOR_SUM", [](const SpareObjects&) { glEnable(GL_COLOR_SUM); }},
    StateChange{"CullFace", "GL_CULL_FACE", [](const SpareObjects&) { glEnable(GL_CULL_FACE); }},
    StateChange{"DepthTest", "GL_DEPTH_TEST", [](const SpareObjects&) { glEnable(GL_DEPTH_TEST); }},
    StateChange{"Fog", "GL_FOG", [](const SpareObjects&) { glEnable(GL_FOG); }},
    StateChange{"Lighting", "GL_LIGHTING", [](const SpareObjects&) { glEnable(GL_LIGHTING); }},
    StateChange{"Light3", "GL_LIGHT3", [](const SpareObjects&) { glEnable(GL_LIGHT3); }},
    StateChange{"LineSmooth", "GL_LINE_SMOOTH", [](const SpareObjects&) { glEnable(GL_LINE_SMOOTH); }},
    StateChange{"LineStipple", "GL_LINE_STIPPLE", [](const SpareObjects&) { glEnable(GL_LINE_STIPPLE); }},
    StateChange{"Map2Vertex3", "GL_MAP2_VERTEX_3", [](const SpareObjects&) { glEnable(GL_MAP2_VERTEX_3); }},
    StateChange{"Normalize", "GL_NORMALIZE", [](const SpareObjects&) { glEnable(GL_NORMALIZE); }},
    StateChange{"PointSmooth", "GL_POINT_SMOOTH", [](const SpareObjects&) { glEnable(GL_POINT_SMOOTH); }},
    StateChange{"PointSprite", "GL_POINT_SPRITE", [](const SpareObjects&) { glEnable(GL_POINT_SPRITE); }},
    StateChange{"PolygonOffsetFill", "GL_POLYGON_OFFSET_FILL",
                [](const SpareObjects&) { glEnable(GL_POLYGON_OFFSET_FILL); }},
    StateChange{"PolygonSmooth", "GL_POLYGON_SMOOTH", [](const SpareObjects&) { glEnable(GL_POLYGON_SMOOTH); }},
    StateChange{"PolygonStipple", "GL_POLYGON_STIPPLE", [](const SpareObjects&) { glEnable(GL_POLYGON_STIPPLE); }},
    StateChange{"RescaleNormal", "GL_RESCALE_NORMAL", [](const SpareObjects&) { glEnable(GL_RESCALE_NORMAL); }},
    StateChange{"SampleAlphaToCoverage", "GL_SAMPLE_ALPHA_TO_COVERAGE",
                [](const SpareObjects&) { glEnable(GL_SAMPLE_ALPHA_TO_COVERAGE); }},
    StateChange{"SampleCoverage", "GL_SAMPLE_COVERAGE", [](const SpareObjects&) { glEnable(GL_SAMPLE_COVERAGE); }},
    StateChange{"ScissorTest", "GL_SCISSOR_TEST", [](const SpareObjects&) { glEnable(GL_SCISSOR_TEST); }},
    StateChange{"StencilTest", "GL_STENCIL_TEST", [](const SpareObjects&) { glEnable(GL_STENCIL_TEST); }},
    StateChange{"ClipPlane2", "GL_CLIP_PLANE2", [](const SpareObjects&) { glEnable(GL_CLIP_PLANE2); }},
    StateChange{"VertexProgramPointSize", "GL_VERTEX_PROGRAM_POINT_SIZE",
                [](const SpareObjects&) { glEnable(GL_VERTEX_PROGRAM_POINT_SIZE); }},
    StateChange{"VertexProgramTwoSide", "GL_VERTEX_PROGRAM_TWO_SIDE",
                [](const SpareObjects&) { glEnable(GL_VERTEX_PROGRAM_TWO_SIDE); }},
    StateChange{"FramebufferSrgb", "GL_FRAMEBUFFER_SRGB", [](const SpareObjects&) { glEnable(GL_FRAMEBUFFER_SRGB); }},
    StateChange{"RasterizerDiscard", "GL_RASTERIZER_DISCARD",
                [](const SpareObjects&) { glEnable(GL_RASTERIZER_DISCARD); }},
    StateChange{"PrimitiveRestart", "GL_PRIMITIVE_RESTART",
                [](const SpareObjects&) { glEnable(GL_PRIMITIVE_RESTART); }},
    StateChange{"DepthClamp", "GL_DEPTH_CLAMP", [](const SpareObjects&) { glEnable(GL_DEPTH_CLAMP); }},
    StateChange{"TextureCubeMapSeamless", "GL_TEXTURE_CUBE_MAP_SEAMLESS",
                [](const SpareObjects&) { glEnable(GL_TEXTURE_CUBE_MAP_SEAMLESS); }},
    StateChange{"SampleMask", "GL_SAMPLE_MASK", [](const SpareObjects&) { glEnable(GL_SAMPLE_MASK); }},
    StateChange{"Dither", "GL_DITHER", [](const SpareObjects&) { glDisable(GL_DITHER); }},
    StateChange{"Multisample", "GL_MULTISAMPLE", [](const SpareObjects&) { glDisable(GL_MULTISAMPLE); }},
    StateChange{"AlphaTestRef", "GL_ALPHA_TEST_REF", [](const SpareObjects&) { glAlphaFunc(GL_ALWAYS, 0.25F); }},
    StateChange{"AlphaTestFunc", "GL_ALPHA_TEST_FUNC", [](const SpareObjects&) { glAlphaFunc(GL_GREATER, 0.0F); }},
    StateChange{"BlendSrcRgb", "GL_BLEND_SRC_RGB",
                [](const SpareObjects&) { glBlendFuncSeparate(GL_DST_COLOR, GL_ZERO, GL_ONE, GL_ZERO); }},
    StateChange{"BlendDstAlpha", "GL_BLEND_DST_ALPHA",
                [](const SpareObjects&) { glBlendFuncSeparate(GL_ONE, GL_ZERO, GL_ONE, GL_SRC_ALPHA); }},
    StateChange{"BlendEquationRgb", "GL_BLEND_EQUATION_RGB",
                [](const SpareObjects&) { glBlendEquationSeparate(GL_MIN, GL_FUNC_ADD); }},
    StateChange{"BlendOfOneDrawBuffer", "GL_BLEND", [](const SpareObjects&) { glEnablei(GL_BLEND, 3); }},
    StateChange{"BlendColor", "GL_BLEND_COLOR", [](const SpareObjects&) { glBlendColor(0.1F, 0.2F, 0.3F, 0.4F); }},
    StateChange{"LogicOpMode", "GL_LOGIC_OP_MODE", [](const SpareObjects&) { glLogicOp(GL_XOR); }},
    StateChange{"ColorWritemask", "GL_COLOR_WRITEMASK",
                [](const SpareObjects&) { glColorMask(GL_TRUE, GL_FALSE, GL_TRUE, GL_TRUE); }},
    StateChange{"ColourMaskOfOneDrawBuffer", "GL_COLOR_WRITEMASK",
                [](const SpareObjects&) { glColorMaski(2, GL_TRUE, GL_TRUE, GL_TRUE, GL_FALSE); }},
    StateChange{"ColorClearValue", "GL_COLOR_CLEAR_VALUE",
                [](const SpareObjects&) { glClearColor(0.5F, 0.0F, 0.0F, 0.0F); }},
    StateChange{"AccumClearValue", "GL_ACCUM_CLEAR_VALUE",
                [](const SpareObjects&) { glClearAccum(0.5F, 0.0F, 0.0F, 0.0F); }},
    StateChange{"DepthClearValue", "GL_DEPTH_CLEAR_VALUE", [](const SpareObjects&) { glClearDepth(0.5); }},
    StateChange{"StencilClearValue", "GL_STENCIL_CLEAR_VALUE", [](const SpareObjects&) { glClearStencil(3); }},
    StateChange{"DepthFunc", "GL_DEPTH_FUNC", [](const SpareObjects&) { glDepthFunc(GL_GEQUAL); }},
    StateChange{"DepthWritemask", "GL_DEPTH_WRITEMASK", [](const SpareObjects&) { glDepthMask(GL_FALSE); }},
    StateChange{"DepthRange", "GL_DEPTH_RANGE", [](const SpareObjects&) { glDepthRange(0.25, 0.75); }},
    StateChange{"DepthRangeOfOneViewport", "GL_DEPTH_RANGE",
                [](const SpareObjects&) { glDepthRangeIndexed(5, 0.25, 0.75); }},
    StateChange{"StencilFunc", "GL_STENCIL_FUNC",
                [](const SpareObjects&) { glStencilFuncSeparate(GL_FRONT, GL_LESS, 0, 0xFFU); }},
    StateChange{"StencilValueMask", "GL_STENCIL_VALUE_MASK",
                [](const SpareObjects&) { glStencilFuncSeparate(GL_FRONT, GL_ALWAYS, 0, 0x0FU); }},
    StateChange{"StencilBackFunc", "GL_STENCIL_BACK_FUNC",
                [](const SpareObjects&) { glStencilFuncSeparate(GL_BACK, GL_EQUAL, 0, 0xFFU); }},
    StateChange{"StencilBackPassDepthPass", "GL_STENCIL_BACK_PASS_DEPTH_PASS",
                [](const SpareObjects&) { glStencilOpSeparate(GL_BACK, GL_KEEP, GL_KEEP, GL_INCR); }},
    StateChange{"StencilFail", "GL_STENCIL_FAIL",
                [](const SpareObjects&) { glStencilOpSeparate(GL_FRONT, GL_INVERT, GL_KEEP, GL_KEEP); }},
    StateChange{"StencilWritemask", "GL_STENCIL_WRITEMASK",
                [](const SpareObjects&) { glStencilMaskSeparate(GL_FRONT, 0x0FU); }},
    StateChange{"CullFaceMode", "GL_CULL_FACE_MODE", [](const SpareObjects&) { glCullFace(GL_FRONT); }},
    StateChange{"FrontFace", "GL_FRONT_FACE", [](const SpareObjects&) { glFrontFace(GL_CW); }},
    StateChange{"PolygonMode", "GL_POLYGON_MODE", [](const SpareObjects&) { glPolygonMode(GL_BACK, GL_LINE); }},
    StateChange{"PolygonOffsetFactor", "GL_POLYGON_OFFSET_FACTOR",
                [](const SpareObjects&) { glPolygonOffset(2.0F, 0.0F); }},
    StateChange{"PolygonOffsetUnits", "GL_POLYGON_OFFSET_UNITS",
                [](const SpareObjects&) { glPolygonOffset(0.0F, 2.0F); }},
    StateChange{"ShadeModel", "GL_SHADE_MODEL", [](const SpareObjects&) { glShadeModel(GL_FLAT); }},
    StateChange{"LineWidth", "GL_LINE_WIDTH", [](const SpareObjects&) { glLineWidth(3.0F); }},
    StateChange{"LineStipplePattern", "GL_LINE_STIPPLE_PATTERN", [](const SpareObjects&) { glLineStipple(1, 0x0F0F); }},
    StateChange{"PointSize", "GL_POINT_SIZE", [](const SpareObjects&) { glPointSize(4.0F); }},
    StateChange{"PointDistanceAttenuation", "GL_POINT_DISTANCE_ATTENUATION",
                [](const SpareObjects&) { glPointParameterfv(GL_POINT_DISTANCE_ATTENUATION, kVector.data()); }},
    StateChange{"PointSpriteCoordOrigin", "GL_POINT_SPRITE_COORD_ORIGIN",
                [](const SpareObjects&) { glPointParameteri(GL_POINT_SPRITE_COORD_ORIGIN, GL_LOWER_LEFT); }},
    StateChange{"ProvokingVertex", "GL_PROVOKING_VERTEX",
                [](const SpareObjects&) { glProvokingVertex(GL_FIRST_VERTEX_CONVENTION); }},
    StateChange{"PrimitiveRestartIndex", "GL_PRIMITIVE_RESTART_INDEX",
                [](const SpareObjects&) { glPrimitiveRestartIndex(99); }},
    StateChange{"PolygonStipplePattern", "polygon stipple",
                [](const SpareObjects&) {
                    const std::array<GLubyte, 128> pattern{0x5A};
                    glPolygonStipple(pattern.data());
                }},
    StateChange{"Viewport", "GL_VIEWPORT", [](const SpareObjects&) { glViewport(1, 2, 3, 4); }},
    StateChange{"OneViewportOfMany", "GL_VIEWPORT",
                [](const SpareObjects&) { glViewportIndexedf(7, 1.0F, 2.0F, 3.0F, 4.0F); }},
    StateChange{"ScissorBox", "GL_SCISSOR_BOX", [](const SpareObjects&) { glScissor(1, 2, 3, 4); }},
    StateChange{"SampleCoverageValue", "GL_SAMPLE_COVERAGE_VALUE",
                [](const SpareObjects&) { glSampleCoverage(0.5F, GL_FALSE); }},
    StateChange{"SampleMaskValue", "GL_SAMPLE_MASK_VALUE", [](const SpareObjects&) { glSampleMaski(0, 0x5U); }},
    StateChange{"FogMode", "GL_FOG_MODE", [](const SpareObjects&) { glFogi(GL_FOG_MODE, GL_LINEAR); }},
    StateChange{"FogDensity", "GL_FOG_DENSITY", [](const SpareObjects&) { glFogf(GL_FOG_DENSITY, 0.3F); }},
    StateChange{"FogColor", "GL_FOG_COLOR", [](const SpareObjects&) { glFogfv(GL_FOG_COLOR, kVector.data()); }},
    StateChange{"FogCoordSrc", "GL_FOG_COORD_SRC", [](const SpareObjects&) { glFogi(GL_FOG_COORD_SRC, GL_FOG_COORD); }},
    StateChange{"LightModelAmbient", "GL_LIGHT_MODEL_AMBIENT",
                [](const SpareObjects&) { glLightModelfv(GL_LIGHT_MODEL_AMBIENT, kVector.data()); }},
    StateChange{"LightModelTwoSide", "GL_LIGHT_MODEL_TWO_SIDE",
                [](const SpareObjects&) { glLightModeli(GL_LIGHT_MODEL_TWO_SIDE, GL_TRUE); }},
    StateChange{"Light5Diffuse", "GL_LIGHT5.GL_DIFFUSE",
                [](const SpareObjects&) { glLightfv(GL_LIGHT5, GL_DIFFUSE, kVector.data()); }},
    StateChange{"Light1Position", "GL_LIGHT1.GL_POSITION",
                [](const SpareObjects&) { glLightfv(GL_LIGHT1, GL_POSITION, kVector.data()); }},
    StateChange{"Light2SpotCutoff", "GL_LIGHT2.GL_SPOT_CUTOFF",
                [](const SpareObjects&) { glLightf(GL_LIGHT2, GL_SPOT_CUTOFF, 30.0F); }},
    StateChange{"MaterialBackSpecular", "material GL_BACK.GL_SPECULAR",
                [](const SpareObjects&) { glMaterialfv(GL_BACK, GL_SPECULAR, kVector.data()); }},
    StateChange{"MaterialFrontShininess", "material GL_FRONT.GL_SHININESS",
                [](const SpareObjects&) { glMaterialf(GL_FRONT, GL_SHININESS, 20.0F); }},
    StateChange{"ColorMaterialFace", "GL_COLOR_MATERIAL_FACE",
                [](const SpareObjects&) { glColorMaterial(GL_FRONT, GL_AMBIENT_AND_DIFFUSE); }},
    StateChange{"ClipPlane4Equation", "GL_CLIP_PLANE4.equation",
                [](const SpareObjects&) {
                    const std::array<GLdouble, 4> plane{1.0, 2.0, 3.0, 4.0};
                    glClipPlane(GL_CLIP_PLANE4, plane.data());
                }},
    StateChange{"CurrentColor", "GL_CURRENT_COLOR", [](const SpareObjects&) { glColor4fv(kVector.data()); }},
    StateChange{"CurrentSecondaryColor", "GL_CURRENT_SECONDARY_COLOR",
                [](const SpareObjects&) { glSecondaryColor3fv(kVector.data()); }},
    StateChange{"CurrentNormal", "GL_CURRENT_NORMAL", [](const SpareObjects&) { glNormal3f(0.0F, 1.0F, 0.0F); }},
    StateChange{"EdgeFlag", "GL_EDGE_FLAG", [](const SpareObjects&) { glEdgeFlag(GL_FALSE); }},
    StateChange{"Unit2CurrentTextureCoords", "unit 2.GL_CURRENT_TEXTURE_COORDS",
                [](const SpareObjects&) { glMultiTexCoord2f(GL_TEXTURE2, 0.5F, 0.25F); }},
    StateChange{"Attribute5Current", "attribute 5.current",
                [](const SpareObjects&) { glVertexAttrib4fv(5, kVector.data()); }},
    StateChange{"MatrixMode", "GL_MATRIX_MODE", [](const SpareObjects&) { glMatrixMode(GL_PROJECTION); }},
    StateChange{"ModelviewMatrix", "GL_MODELVIEW_MATRIX", [](const SpareObjects&) { glTranslatef(1.0F, 2.0F, 3.0F); }},
    StateChange{"ModelviewStackDepth", "GL_MODELVIEW_STACK_DEPTH", [](const SpareObjects&) { glPushMatrix(); }},
    StateChange{"ProjectionMatrix", "GL_PROJECTION_MATRIX",
                [](const SpareObjects&) {
                    glMatrixMode(GL_PROJECTION);
                    glScalef(2.0F, 2.0F, 2.0F);
                    glMatrixMode(GL_MODELVIEW);
                }},
    StateChange{"Unit3TextureMatrix", "unit 3.GL_TEXTURE_MATRIX",
                [](const SpareObjects&) {
                    glMatrixMode(GL_TEXTURE);
                    glActiveTexture(GL_TEXTURE3);
                    glScalef(2.0F, 2.0F, 2.0F);
                    glActiveTexture(GL_TEXTURE0);
                    glMatrixMode(GL_MODELVIEW);
                }},
    StateChange{"AttribStackDepth", "GL_ATTRIB_STACK_DEPTH", [](const SpareObjects&) { glPushAttrib(GL_CURRENT_BIT); }},
    StateChange{"ClientAttribStackDepth", "GL_CLIENT_ATTRIB_STACK_DEPTH",
                [](const SpareObjects&) { glPushClientAttrib(GL_CLIENT_PIXEL_STORE_BIT); }},
    StateChange{"ListBase", "GL_LIST_BASE", [](const SpareObjects&) { glListBase(7); }},
    StateChange{"ClipDepthMode", "GL_CLIP_DEPTH_MODE",
                [](const SpareObjects&) { glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE); }},
    StateChange{"FogHint", "GL_FOG_HINT", [](const SpareObjects&) { glHint(GL_FOG_HINT, GL_NICEST); }},
    StateChange{"PackAlignment", "GL_PACK_ALIGNMENT", [](const SpareObjects&) { glPixelStorei(GL_PACK_ALIGNMENT, 1); }},
    StateChange{"UnpackRowLength", "GL_UNPACK_ROW_LENGTH",
                [](const SpareObjects&) { glPixelStorei(GL_UNPACK_ROW_LENGTH, 17); }},
    StateChange{"RedScale", "GL_RED_SCALE", [](const SpareObjects&) { glPixelTransferf(GL_RED_SCALE, 0.5F); }},
    StateChange{"DepthBias", "GL_DEPTH_BIAS", [](const SpareObjects&) { glPixelTransferf(GL_DEPTH_BIAS, 0.5F); }},
    StateChange{"ZoomX", "GL_ZOOM_X", [](const SpareObjects&) { glPixelZoom(2.0F, 1.0F); }},
    StateChange{"PixelMapRToR", "GL_PIXEL_MAP_R_TO_R",
                [](const SpareObjects&) { glPixelMapfv(GL_PIXEL_MAP_R_TO_R, 2, kVector.data()); }},
    StateChange{"Map1GridSegments", "GL_MAP1_GRID_SEGMENTS", [](const SpareObjects&) { glMapGrid1f(5, 0.0F, 1.0F); }},
    StateChange{"ActiveTexture", "GL_ACTIVE_TEXTURE", [](const SpareObjects&) { glActiveTexture(GL_TEXTURE4); }},
    StateChange{"ClientActiveTexture", "GL_CLIENT_ACTIVE_TEXTURE",
                [](const SpareObjects&) { glClientActiveTexture(GL_TEXTURE1); }},
    StateChange{"Unit0Texture2d", "unit 0.GL_TEXTURE_2D", [](const SpareObjects&) { glEnable(GL_TEXTURE_2D); }},
    StateChange{"Unit1TextureCubeMap", "unit 1.GL_TEXTURE_CUBE_MAP",
                [](const SpareObjects&) {
                    glActiveTexture(GL_TEXTURE1);
                    glEnable(GL_TEXTURE_CUBE_MAP);
                    glActiveTexture(GL_TEXTURE0);
                }},
    StateChange{"Unit0TextureEnvMode", "unit 0.GL_TEXTURE_ENV_MODE",
                [](const SpareObjects&) { glTexEnvi(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, GL_DECAL); }},
    StateChange{"Unit0TextureEnvColor", "unit 0.GL_TEXTURE_ENV_COLOR",
                [](const SpareObjects&) { glTexEnvfv(GL_TEXTURE_ENV, GL_TEXTURE_ENV_COLOR, kVector.data()); }},
    StateChange{"Unit0Src1Rgb", "unit 0.GL_SRC1_RGB",
                [](const SpareObjects&) { glTexEnvi(GL_TEXTURE_ENV, GL_SRC1_RGB, GL_CONSTANT); }},
    StateChange{"Unit0TextureLodBias", "unit 0.GL_TEXTURE_LOD_BIAS",
                [](const SpareObjects&) { glTexEnvf(GL_TEXTURE_FILTER_CONTROL, GL_TEXTURE_LOD_BIAS, 1.5F); }},
    StateChange{"Unit0TextureGenS", "unit 0.GL_TEXTURE_GEN_S", [](const SpareObjects&) { glEnable(GL_TEXTURE_GEN_S); }},
    StateChange{"Unit0TextureGenRMode", "unit 0.GL_TEXTURE_GEN_R.mode",
                [](const SpareObjects&) { glTexGeni(GL_R, GL_TEXTURE_GEN_MODE, GL_REFLECTION_MAP); }},
    StateChange{"Unit0TextureGenTObjectPlane", "unit 0.GL_TEXTURE_GEN_T.object plane",
                [](const SpareObjects&) { glTexGenfv(GL_T, GL_OBJECT_PLANE, kVector.data()); }},
    StateChange{"Unit0TextureBinding2d", "unit 0.GL_TEXTURE_BINDING_2D",
                [](const SpareObjects& objects) { glBindTexture(GL_TEXTURE_2D, objects.texture_2d); }},
    StateChange{"Unit11TextureBinding3d", "unit 11.GL_TEXTURE_BINDING_3D",
                [](const SpareObjects& objects) {
                    glActiveTexture(GL_TEXTURE11);
                    glBindTexture(GL_TEXTURE_3D, objects.texture_3d);
                    glActiveTexture(GL_TEXTURE0);
                }},
    StateChange{"Unit40TextureBindingCubeMap", "unit 40.GL_TEXTURE_BINDING_CUBE_MAP",
                [](const SpareObjects& objects) {
                    glActiveTexture(GL_TEXTURE0 + 40);
                    glBindTexture(GL_TEXTURE_CUBE_MAP, objects.texture_cube);
                    glActiveTexture(GL_TEXTURE0);
                }},
    StateChange{"Unit6SamplerBinding", "unit 6.GL_SAMPLER_BINDING",
                [](const SpareObjects& objects) { glBindSampler(6, objects.sampler); }},
    StateChange{"ImageUnit1ImageBindingName", "image unit 1.GL_IMAGE_BINDING_NAME",
                [](const SpareObjects& objects) {
                    glBindImageTexture(1, objects.texture_2d, 0, GL_FALSE, 0, GL_READ_ONLY, GL_R8);
                }},
    StateChange{"DrawFramebufferBinding", "GL_DRAW_FRAMEBUFFER_BINDING",
                [](const SpareObjects& objects) { glBindFramebuffer(GL_DRAW_FRAMEBUFFER, objects.framebuffer); }},
    StateChange{"ReadFramebufferBinding", "GL_READ_FRAMEBUFFER_BINDING",
                [](const SpareObjects& objects) { glBindFramebuffer(GL_READ_FRAMEBUFFER, objects.framebuffer); }},
    StateChange{"RenderbufferBinding", "GL_RENDERBUFFER_BINDING",
                [](const SpareObjects& objects) { glBindRenderbuffer(GL_RENDERBUFFER, objects.renderbuffer); }},
    StateChange{"CurrentProgram", "GL_CURRENT_PROGRAM",
                [](const SpareObjects& objects) { glUseProgram(objects.program); }},
    StateChange{"VertexArrayBinding", "GL_VERTEX_ARRAY_BINDING",
                [](const SpareObjects& objects) { glBindVertexArray(objects.vertex_array); }},
    StateChange{"UniformBuffer3", "uniform buffer 3",
                [](const SpareObjects& objects) {
                    glBindBufferRange(GL_UNIFORM_BUFFER, 3, objects.buffer, 0, 64);
                    glBindBuffer(GL_UNIFORM_BUFFER, 0);
                }},
    StateChange{"QuerySamplesPassed", "query.GL_SAMPLES_PASSED",
                [](const SpareObjects& objects) { glBeginQuery(GL_SAMPLES_PASSED, objects.query); }},
    StateChange{"ClientVertexArray", "GL_VERTEX_ARRAY",
                [](const SpareObjects&) { glEnableClientState(GL_VERTEX_ARRAY); }},
    StateChange{"Unit1TextureCoordArray", "unit 1.GL_TEXTURE_COORD_ARRAY",
                [](const SpareObjects&) {
                    glClientActiveTexture(GL_TEXTURE1);
                    glEnableClientState(GL_TEXTURE_COORD_ARRAY);
                    glClientActiveTexture(GL_TEXTURE0);
                }},
    StateChange{"ColorArrayStride", "GL_COLOR_ARRAY.stride",
                [](const SpareObjects&) { glColorPointer(4, GL_FLOAT, 32, nullptr); }},
    StateChange{"Attribute7Enabled", "attribute 7.enabled", [](const SpareObjects&) { glEnableVertexAttribArray(7); }},
    StateChange{"Attribute9Divisor", "attribute 9.divisor", [](const SpareObjects&) { glVertexAttribDivisor(9, 1); }},
    StateChange{"DebugOutputSynchronous", "GL_DEBUG_OUTPUT_SYNCHRONOUS",
                [](const SpareObjects&) { glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS); }},
    StateChange{"VertexProgramBinding", "vertex program.binding",
                [](const SpareObjects&) { glBindProgramARB(GL_VERTEX_PROGRAM_ARB, 77); }},
    StateChange{"PatchVertices", "GL_PATCH_VERTICES",
                [](const SpareObjects&) { glPatchParameteri(GL_PATCH_VERTICES, 5); }},
    StateChange{"ArrayBufferBinding", "GL_ARRAY_BUFFER_BINDING",
                [](const SpareObjects& objects) { glBindBuffer(GL_ARRAY_BUFFER, objects.buffer); }},
    StateChange{"ElementArrayBufferBinding", "GL_ELEMENT_ARRAY_BUFFER_BINDING",
                [](const SpareObjects& objects) { glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, objects.buffer); }},
    StateChange{"PixelPackBufferBinding", "GL_PIXEL_PACK_BUFFER_BINDING",
                [](const SpareObjects& objects) { glBindBuffer(GL_PIXEL_PACK_BUFFER, objects.buffer); }},
    StateChange{"PixelUnpackBufferBinding", "GL_PIXEL_UNPACK_BUFFER_BINDING",
                [](const SpareObjects& objects) { glBindBuffer(GL_PIXEL_UNPACK_BUFFER, objects.buffer); }},
    StateChange{"CopyReadBufferBinding", "GL_COPY_READ_BUFFER_BINDING",
                [](const SpareObjects& objects) { glBindBuffer(GL_COPY_READ_BUFFER, objects.buffer); }},
    StateChange{"CopyWriteBufferBinding", "GL_COPY_WRITE_BUFFER_BINDING",
                [](const SpareObjects& objects) { glBindBuffer(GL_COPY_WRITE_BUFFER, objects.buffer); }},
    StateChange{"UniformBufferBinding", "GL_UNIFORM_BUFFER_BINDING",
                [](const SpareObjects& objects) { glBindBuffer(GL_UNIFORM_BUFFER, objects.buffer); }},
    StateChange{"DrawIndirectBufferBinding", "GL_DRAW_INDIRECT_BUFFER_BINDING",
                [](const SpareObjects& objects) { glBindBuffer(GL_DRAW_INDIRECT_BUFFER, objects.buffer); }},
    StateChange{"ShaderStorageBufferBinding", "GL_SHADER_STORAGE_BUFFER_BINDING",
                [](const SpareObjects& objects) { glBindBuffer(GL_SHADER_STORAGE_BUFFER, objects.buffer); }},
    StateChange{"QueryBufferBinding", "GL_QUERY_BUFFER_BINDING",
                [](const SpareObjects& objects) { glBindBuffer(GL_QUERY_BUFFER, objects.buffer); }},
};

GLuint makeProgram() {
    const GLuint shader = glCreateShader(GL_VERTEX_SHADER);
    const char* source = "#version 120\nvoid main() { gl_Position = gl_Vertex; }\n";
    glShaderSource(shader, 1, &source, nullptr);
    glCompileShader(shader);
    const GLuint program = glCreateProgram();
    glAttachShader(program, shader);
    glLinkProgram(program);
    glDeleteShader(shader);
    return program;
}

/// A name becomes an object when it is first bound.
GLuint makeTexture(GLenum target) {
    GLuint texture = 0;
    glGenTextures(1, &texture);
    glBindTexture(target, texture);
    if (target == GL_TEXTURE_2D) {
        glTexStorage2D(target, 1, GL_R8, 4, 4);
    }
    glBindTexture(target, 0);
    return texture;
}

GLuint makeFramebuffer() {
    GLuint framebuffer = 0;
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    return framebuffer;
}

}  // namespace

SpareObjects::SpareObjects()
    : texture_2d(makeTexture(GL_TEXTURE_2D)),
      texture_3d(makeTexture(GL_TEXTURE_3D)),
      texture_cube(makeTexture(GL_TEXTURE_CUBE_MAP)),
      framebuffer(makeFramebuffer()),
      // Bound from here on: changing from one framebuffer object to another moves one line, whereas the default
      // framebuffer would also differ in its draw and read buffers.
      bound_framebuffer(makeFramebuffer()),
      program(makeProgram()) {
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glBufferData(GL_ARRAY_BUFFER, 256, nullptr, GL_STATIC_DRAW);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    glGenRenderbuffers(1, &renderbuffer);
    glGenSamplers(1, &sampler);
    glGenVertexArrays(1, &vertex_array);
    glGenQueries(1, &query);
}

SpareObjects::~SpareObjects() {
    glDeleteProgram(program);
    glDeleteQueries(1, &query);
    glDeleteVertexArrays(1, &vertex_array);
    glDeleteSamplers(1, &sampler);
    glDeleteFramebuffers(1, &framebuffer);
    glDeleteFramebuffers(1, &bound_framebuffer);
    glDeleteRenderbuffers(1, &renderbuffer);
    glDeleteBuffers(1, &buffer);
    for (const GLuint texture : {texture_2d, texture_3d, texture_cube}) {
        glDeleteTextures(1, &texture);
    }
}

std::span<const StateChange> stateChanges() {
    return kChanges;
}

}  // namespace sluice::host::test
