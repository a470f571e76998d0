// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <GL/glcorearb.h>

#include "ipc/base/result.hpp"

namespace handcast::renderer::gl {

/// The functions of OpenGL that this back end calls: the name of the type's part in glcorearb.h,
/// and the name without `gl`.
#define HANDCAST_GL_FUNCTIONS(F)                              \
  F(ATTACHSHADER, AttachShader)                               \
  F(BEGINQUERY, BeginQuery)                                   \
  F(BINDBUFFER, BindBuffer)                                   \
  F(BINDBUFFERBASE, BindBufferBase)                           \
  F(BINDFRAMEBUFFER, BindFramebuffer)                         \
  F(BINDIMAGETEXTURE, BindImageTexture)                       \
  F(BINDTEXTUREUNIT, BindTextureUnit)                         \
  F(BINDVERTEXARRAY, BindVertexArray)                         \
  F(CHECKNAMEDFRAMEBUFFERSTATUS, CheckNamedFramebufferStatus) \
  F(CLEARNAMEDFRAMEBUFFERFV, ClearNamedFramebufferfv)         \
  F(CLEARNAMEDFRAMEBUFFERUIV, ClearNamedFramebufferuiv)       \
  F(CLEARTEXIMAGE, ClearTexImage)                             \
  F(CLIENTWAITSYNC, ClientWaitSync)                           \
  F(CLIPCONTROL, ClipControl)                                 \
  F(COMPILESHADER, CompileShader)                             \
  F(COPYNAMEDBUFFERSUBDATA, CopyNamedBufferSubData)           \
  F(CREATEBUFFERS, CreateBuffers)                             \
  F(CREATEFRAMEBUFFERS, CreateFramebuffers)                   \
  F(CREATEPROGRAM, CreateProgram)                             \
  F(CREATEQUERIES, CreateQueries)                             \
  F(CREATESHADER, CreateShader)                               \
  F(CREATETEXTURES, CreateTextures)                           \
  F(CREATEVERTEXARRAYS, CreateVertexArrays)                   \
  F(CULLFACE, CullFace)                                       \
  F(DELETEBUFFERS, DeleteBuffers)                             \
  F(DELETEFRAMEBUFFERS, DeleteFramebuffers)                   \
  F(DELETEPROGRAM, DeleteProgram)                             \
  F(DELETEQUERIES, DeleteQueries)                             \
  F(DELETESHADER, DeleteShader)                               \
  F(DELETESYNC, DeleteSync)                                   \
  F(DELETETEXTURES, DeleteTextures)                           \
  F(DELETEVERTEXARRAYS, DeleteVertexArrays)                   \
  F(DEPTHFUNC, DepthFunc)                                     \
  F(DISABLE, Disable)                                         \
  F(DISPATCHCOMPUTEINDIRECT, DispatchComputeIndirect)         \
  F(DISPATCHCOMPUTE, DispatchCompute)                         \
  F(DRAWARRAYS, DrawArrays)                                   \
  F(DRAWELEMENTS, DrawElements)                               \
  F(ENABLE, Enable)                                           \
  F(ENABLEVERTEXARRAYATTRIB, EnableVertexArrayAttrib)         \
  F(ENDQUERY, EndQuery)                                       \
  F(FENCESYNC, FenceSync)                                     \
  F(GETERROR, GetError)                                       \
  F(GETGRAPHICSRESETSTATUS, GetGraphicsResetStatus)           \
  F(GETPROGRAMINFOLOG, GetProgramInfoLog)                     \
  F(GETPROGRAMIV, GetProgramiv)                               \
  F(GETQUERYOBJECTUI64V, GetQueryObjectui64v)                 \
  F(GETSHADERINFOLOG, GetShaderInfoLog)                       \
  F(GETSHADERIV, GetShaderiv)                                 \
  F(GETSTRING, GetString)                                     \
  F(LINKPROGRAM, LinkProgram)                                 \
  F(MAPNAMEDBUFFERRANGE, MapNamedBufferRange)                 \
  F(MEMORYBARRIER, MemoryBarrier)                             \
  F(NAMEDBUFFERSTORAGE, NamedBufferStorage)                   \
  F(NAMEDBUFFERSUBDATA, NamedBufferSubData)                   \
  F(NAMEDFRAMEBUFFERDRAWBUFFERS, NamedFramebufferDrawBuffers) \
  F(NAMEDFRAMEBUFFERREADBUFFER, NamedFramebufferReadBuffer)   \
  F(NAMEDFRAMEBUFFERTEXTURE, NamedFramebufferTexture)         \
  F(PIXELSTOREI, PixelStorei)                                 \
  F(PROVOKINGVERTEX, ProvokingVertex)                         \
  F(PROGRAMUNIFORM1I, ProgramUniform1i)                       \
  F(PROGRAMUNIFORM1UI, ProgramUniform1ui)                     \
  F(PROGRAMUNIFORM2F, ProgramUniform2f)                       \
  F(PROGRAMUNIFORM4I, ProgramUniform4i)                       \
  F(READPIXELS, ReadPixels)                                   \
  F(SCISSOR, Scissor)                                         \
  F(SHADERSOURCE, ShaderSource)                               \
  F(TEXTUREPARAMETERI, TextureParameteri)                     \
  F(TEXTURESTORAGE2D, TextureStorage2D)                       \
  F(TEXTURESUBIMAGE2D, TextureSubImage2D)                     \
  F(USEPROGRAM, UseProgram)                                   \
  F(VERTEXARRAYATTRIBBINDING, VertexArrayAttribBinding)       \
  F(VERTEXARRAYATTRIBFORMAT, VertexArrayAttribFormat)         \
  F(VERTEXARRAYATTRIBIFORMAT, VertexArrayAttribIFormat)       \
  F(VERTEXARRAYELEMENTBUFFER, VertexArrayElementBuffer)       \
  F(VERTEXARRAYVERTEXBUFFER, VertexArrayVertexBuffer)         \
  F(VIEWPORT, Viewport)

/// Pointers to these functions, valid in the contexts of the display they were loaded from.
struct Functions {
#define HANDCAST_GL_MEMBER(type, name) PFNGL##type##PROC name = nullptr;
  HANDCAST_GL_FUNCTIONS(HANDCAST_GL_MEMBER)
#undef HANDCAST_GL_MEMBER
};

/// Finds an address by a function's full name; nullptr if there is none. eglGetProcAddress().
using FindFunction = void (*(*)(const char* name))();

/// Loads all functions. Errors (unavailable): one is missing.
Result<Functions> load_functions(FindFunction find);

}  // namespace handcast::renderer::gl
