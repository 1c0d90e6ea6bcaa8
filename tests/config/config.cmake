# What a user reads who runs a broken case.
kerf_python_test(config.messages config/broken_cases.py BrokenCases config)
