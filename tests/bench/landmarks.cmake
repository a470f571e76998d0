add_executable(bench_landmarks landmarks.cpp)
target_link_libraries(bench_landmarks PRIVATE handcast_network fmt::fmt)
