"""The commands of `flexlash`, one module each; what a command needs is loaded when it is called."""
