package voqcal.spy;

import java.awt.BorderLayout;
import java.awt.event.ActionEvent;
import javax.swing.AbstractAction;
import javax.swing.Action;
import javax.swing.JDesktopPane;
import lcm.spy.ChannelData;
import lcm.spy.SpyPlugin;
import voqcal.image_t;
import voqcal.pointcloud2_t;

/** What lcm-spy offers beside its own viewer for images and clouds: a view with the board in it. */
public class BoardPlugin implements SpyPlugin {
  @Override
  public boolean canHandle(long fingerprint) {
    return fingerprint == image_t.LCM_FINGERPRINT || fingerprint == pointcloud2_t.LCM_FINGERPRINT;
  }

  /** lcm-spy asks first without pane and channel, just for the name that goes into its menu. */
  @Override
  public Action getAction(JDesktopPane pane, ChannelData channel) {
    return new AbstractAction("Show with board") {
      @Override
      public void actionPerformed(ActionEvent event) {
        boolean isImage = channel.fingerprint == image_t.LCM_FINGERPRINT;
        pane.setLayout(new BorderLayout());
        pane.add(isImage ? new ImageView(channel.name) : new CloudView(channel.name));
        pane.revalidate();
      }
    };
  }
}
