# Coupling physics as functions over arrays.
add_executable(methods_tests unit/methods_locate.cpp unit/methods_forces.cpp
                             unit/methods_overlap.cpp)
target_link_libraries(methods_tests PRIVATE kerf::methods kerf::warnings GTest::gtest_main)
gtest_discover_tests(methods_tests)
