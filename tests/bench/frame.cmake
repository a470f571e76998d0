find_package(OpenCV REQUIRED COMPONENTS core imgproc)

add_executable(bench_frame frame.cpp frame_pipeline.cpp nearest_against_opencv.cpp)
target_link_libraries(bench_frame PRIVATE handcast_pipeline handcast_cpu benchmark::benchmark fmt::fmt opencv_imgproc opencv_core)
if(TARGET handcast_hands)
  add_dependencies(bench_frame handcast_hands)
endif()
