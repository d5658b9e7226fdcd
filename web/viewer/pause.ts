/** Lets the caller's thread receive messages. A timer would wait for 4 ms if others ran before. */
export const pause = () => new Promise<void>((resolve) => {
  const { port1, port2 } = new MessageChannel();
  port1.onmessage = () => {
    port1.close();
    resolve();
  };
  port2.postMessage(null);
});
