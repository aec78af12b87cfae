/* SPDX-License-Identifier: MIT
 * The same in the hands of SDL 2, which opens libGL itself: a pyramid in perspective, then a bar over it. Prints a hash of
 * the window of each frame. Usage: sdl_target [FRAMES] */
#include <SDL2/SDL.h>
#include <SDL2/SDL_opengl.h>
#include <SDL2/SDL_syswm.h>
#include <X11/Xutil.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { kWidth = 96, kHeight = 64 };

/* What SDL gives for a name. */
typedef void(APIENTRY* DrawArrays)(GLenum, GLint, GLsizei);
typedef void(APIENTRY* Mode)(GLenum);
typedef void(APIENTRY* Nothing)(void);
typedef void(APIENTRY* Six)(GLdouble, GLdouble, GLdouble, GLdouble, GLdouble, GLdouble);

static void look_up(const char* name, void* function) {
    void* found = SDL_GL_GetProcAddress(name);
    memcpy(function, &found, sizeof(found)); /* ISO C does not convert the one pointer into the other */
}

static void tell(const SDL_SysWMinfo* info, int frame) {
    XImage* image = XGetImage(info->info.x11.display, info->info.x11.window, 0, 0, kWidth, kHeight, AllPlanes, ZPixmap);
    uint64_t hash = 1469598103934665603ULL;
    for (int y = 0; image != NULL && y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            hash = (hash ^ (XGetPixel(image, x, y) & 0xFFFFFFU)) * 1099511628211ULL;
        }
    }
    (void)printf("%d %016llx\n", frame, (unsigned long long)hash);
    if (image != NULL) {
        (void)XDestroyImage(image);
    }
}

int main(int argc, char** argv) {
    const int frames = argc > 1 ? atoi(argv[1]) : 4;
    if (SDL_Init(SDL_INIT_VIDEO) != 0) {
        (void)fprintf(stderr, "sdl_target: %s\n", SDL_GetError());
        return 77;
    }
    (void)SDL_GL_SetAttribute(SDL_GL_DEPTH_SIZE, 24);
    SDL_Window* window = SDL_CreateWindow("sdl_target", 0, 0, kWidth, kHeight, SDL_WINDOW_OPENGL | SDL_WINDOW_BORDERLESS);
    SDL_GLContext context = window == NULL ? NULL : SDL_GL_CreateContext(window);
    SDL_SysWMinfo info;
    SDL_VERSION(&info.version);
    if (context == NULL || !SDL_GetWindowWMInfo(window, &info)) {
        (void)fprintf(stderr, "sdl_target: %s\n", SDL_GetError());
        return 77;
    }
    DrawArrays draw_arrays;
    Mode matrix_mode;
    Nothing load_identity;
    Six frustum, ortho;
    look_up("glDrawArrays", &draw_arrays);
    look_up("glMatrixMode", &matrix_mode);
    look_up("glLoadIdentity", &load_identity);
    look_up("glFrustum", &frustum);
    look_up("glOrtho", &ortho);
    for (int frame = 0; frame < frames; ++frame) {
        const float at = 0.1F * (float)frame;
        const float pyramid[] = {-1, -1, -5, 1, -1, -5, at, 1, -4};
        const float bar[] = {0.1F, 0.1F, 0, 0.9F, 0.1F, 0, 0.5F, 0.2F, 0};
        glViewport(0, 0, kWidth, kHeight);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        glEnableClientState(GL_VERTEX_ARRAY);
        glEnable(GL_DEPTH_TEST);
        matrix_mode(GL_PROJECTION);
        load_identity();
        frustum(-0.75, 0.75, -0.5, 0.5, 1.0, 20.0);
        glColor3f(0.3F, 0.9F, at);
        glVertexPointer(3, GL_FLOAT, 0, pyramid);
        draw_arrays(GL_TRIANGLES, 0, 3);
        matrix_mode(GL_PROJECTION);
        load_identity();
        ortho(0, 1, 0, 1, -1, 1);
        glDisable(GL_DEPTH_TEST);
        glColor3f(1, 1, 1);
        glVertexPointer(3, GL_FLOAT, 0, bar);
        draw_arrays(GL_TRIANGLES, 0, 3);
        SDL_GL_SwapWindow(window);
        glFinish();
        tell(&info, frame);
    }
    SDL_GL_DeleteContext(context);
    SDL_DestroyWindow(window);
    SDL_Quit();
    return 0;
}
