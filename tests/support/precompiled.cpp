// Empty: its target compiles the headers that all test programs share.
