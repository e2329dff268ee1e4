# Debian's mingw-w64, with the threads of C++. The program holds the libraries that it needs.
set(CMAKE_SYSTEM_NAME Windows)
set(CMAKE_SYSTEM_PROCESSOR x86_64)
set(CMAKE_CXX_COMPILER x86_64-w64-mingw32-g++-posix)
set(CMAKE_RC_COMPILER x86_64-w64-mingw32-windres)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)

# GCC does not align the stack for vectors of 32 bytes on Windows (its bug 54412), so that each move must be one that allows
# any address. Files may be larger than 2 GB; the names of functions of Windows 10, without the rare ones.
set(CMAKE_CXX_FLAGS_INIT "-Wa,-muse-unaligned-vector-move -D_FILE_OFFSET_BITS=64 -D_WIN32_WINNT=0x0A00 -DWIN32_LEAN_AND_MEAN -DNOMINMAX")
set(CMAKE_EXE_LINKER_FLAGS_INIT "-static")
